#!/usr/bin/env python3
"""Carts that drive half a metre up their lanes and back, ROUNDS times (the micro-benchmark of OOPSLA 2020, Figure 7).

  lanes.py CARTS [ROUNDS] [--together]

Writes a choreography with its processes to standard output. Each cart has a thread and a lane of its own; with
--together, all of them move in joint steps, for which their durations must be equal.
"""
import sys

PITCH = 650  # millimetres from lane to lane


def main():
    numbers = [int(a) for a in sys.argv[1:] if not a.startswith("--")]
    if not 1 <= len(numbers) <= 2 or min(numbers) < 1:
        sys.exit(__doc__)
    carts, rounds = numbers[0], (numbers + [1])[1]
    together = "--together" in sys.argv
    names = [f"cart{i}" for i in range(carts)]
    print("# check: ok")
    print(f"# {carts} carts in lanes, {rounds} rounds. Written by lanes.py.")
    print('import "../../models/carts.rondo"\n\nworld Hall {')
    for i, name in enumerate(names):
        print(f"  {name}: Cart at (0, {i * PITCH} mm, 0)")
    print("}\n\nchoreography Lanes in Hall {")
    if together:
        print("  option equal_durations")
    state = [f"{name}.x == 0 and {name}.y == 0 and {name}.theta == 0" for name in names]
    print("  initially " + "\n            and ".join(state))
    moves = ["MoveCart(0, 0, 0, 0.5 m, 5 s)", "MoveCart(0.5 m, 0, 0, -0.5 m, 5 s)"] * rounds
    if together:
        for move in moves:
            print("  { " + ",\n    ".join(f"{name}: {move}" for name in names) + " }")
    else:
        print("  parallel {")
        for i, name in enumerate(names):
            low, high = i * PITCH - PITCH // 2, i * PITCH + PITCH // 2
            print(f"    thread region y > {low} mm and y < {high} mm {{")
            for move in moves:
                print(f"      {name}: {move}")
            print("    }")
        print("  }")
    print("}")
    for name in names:
        print(f"\nprocess {name} in Lanes {{")
        for move in moves:
            print(f"  {move}")
        print("}")


if __name__ == "__main__":
    main()
