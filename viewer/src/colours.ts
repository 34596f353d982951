/** Colours of robots: told apart on dark and on light ground, and by people who see fewer colours (Okabe and Ito). */
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#8a6d00", "#7b5ea7"];

export function colourOf(robot: number): string {
  return COLOURS[robot % COLOURS.length]!;
}
