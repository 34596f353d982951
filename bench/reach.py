#!/usr/bin/env python3
"""Reachability: verdict, time and width of the benchmarks, beside measured figures of other tools.

usage: bench/reach.py RONDO [--repeat N]

Figures of Flow*, CAPD and Verse: CPU seconds and widths, measured on one machine of two cores (EPYC, Zen 5); those of
Verse come from eleven runs and enclose nothing. Ours: wall seconds of the decision (reading and checking the file is not
counted) and the width of the same quantity at the end; then how long the checker took.
"""
import argparse
import json
import os
import subprocess
import sys

EXAMPLES = os.path.join(os.path.dirname(__file__), "..", "examples", "reach")

# (file, contract, quantity, peers, bar in seconds, bar for the width)
ROWS = [
    ("laub_loomis", "Narrow", "x4", "Flow* 1.79 s 0.00277; CAPD fails; Verse 0.41 s 0.00241", 0.0285, 0.00258),
    ("laub_loomis", "Middle", "x4", "Flow* 2.84 s 0.0183; CAPD fails; Verse 0.41 s 0.0086", 0.1275, 0.0143),
    ("laub_loomis", "Wide", "x4", "Flow* 27.2 s 0.0330; CAPD fails; Verse 0.48 s 0.0160", 0.2, 0.0331),
    ("van_der_pol", "Run", "y", "Flow* 0.26 s 0.2895; CAPD 192 parts 0.557 s 0.1888", 0.01455, 0.1916),
    ("coupled_van_der_pol", "Mild", "y1", "", None, None),
    ("coupled_van_der_pol", "Strong", "y1", "", None, None),
    ("coupled_van_der_pol_2023", "Run", "y1", "Flow* 1.65 s for 1/90 of it; Ariadne no result", 2.0, None),
    ("quadrotor_altitude", "Narrow", "x3", "Flow* 16.3 s 0.0009; CAPD 0.046 s 0.00089; Verse 0.29 s 0.00099", None, 0.00089),
    ("quadrotor_altitude", "Middle", "x3", "Flow* 16.6 s 0.0037; CAPD 0.043 s 0.00358; Verse 0.26 s 0.0037", 0.05, 0.00354),
    ("quadrotor_altitude", "Wide", "x3", "truly violated: 1.4621 m", None, None),
    ("production_destruction", "Start", "z", "Flow* 2.78 s 0.50532; CAPD fails", 0.2085, 0.50043),
    ("production_destruction", "Rate", "z", "Flow* 3.14 s 0.0449; CAPD fails", 0.3675, 0.00090),
    ("production_destruction", "Both", "z", "Flow* 3.26 s 0.31622; CAPD fails", 0.36, 0.30008),
    ("lotka_volterra", "Orbit", "x", "", None, None),
    ("space_rendezvous", "Rendezvous", "x", "", None, None),
    ("space_rendezvous", "AbortAt(", "x", "", None, None),
    ("space_rendezvous", "AbortSoon", "x", "", None, None),
    ("space_rendezvous", "AbortAtRest", "x", "", None, None),
    ("space_rendezvous", "Abort(", "x", "Ariadne 2025 reports no result", None, None),
    ("thermostat", "Keep", "t", "", 5.0, None),
    ("bang_bang", "Home", "x", "", 5.0, None),
    ("cruise_control", "Follow", "gap", "", 5.0, None),
    ("robertson", "Robertson1", "z", "CAPD 0.136 s 1.4e-9 (of the sum)", 0.2, None),
    ("robertson", "Robertson2", "z", "CAPD 0.706 s 1.4e-8 (of the sum)", 1.0, None),
    ("robertson", "Robertson3", "z", "CAPD 1.29 s 3.3e-8 (of the sum)", 2.0, None),
]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("rondo")
    parser.add_argument("--repeat", type=int, default=3)
    args = parser.parse_args()
    print(f"{'benchmark':<34} {'verdict':<8} {'parts':>5} {'seconds':>8} {'bar':>7} {'width':>10} {'bar':>8} {'certified':>9}  others")
    missed = []
    for file, name, quantity, peers, bar, width_bar in ROWS:
        best = None
        for _ in range(args.repeat):
            out = subprocess.run(
                [args.rondo, "reach", "--json", "--no-cache", "--contract", f"{name}", os.path.join(EXAMPLES, file + ".rondo")],
                capture_output=True, text=True)
            result = json.loads(out.stdout)["contracts"][0]
            if best is None or result["seconds"] < best["seconds"]:
                best = result
        end = best.get("final", {}).get(quantity)
        width = end[1] - end[0] if end else None
        label = f"{file}: {name}"
        certified = f"{best['certify_seconds']:.3f}" if best.get("certified") else "no" if "certified" in best else ""
        print(f"{label:<34} {best['verdict']:<8} {best.get('parts', ''):>5} {best['seconds']:>8.4f} "
              f"{bar if bar else '':>7} {f'{width:.4g}' if width is not None else '':>10} {width_bar if width_bar else '':>8} {certified:>9}  {peers}")
        if bar and best["seconds"] > bar:
            missed.append(f"{label}: {best['seconds']:.4f} s, bar {bar} s")
        if width_bar and width and width > width_bar * 1.0005:
            missed.append(f"{label}: width {width:.5g}, bar {width_bar}")
        expected = "refuted" if (file, name) == ("quadrotor_altitude", "Wide") else "proved"
        if best["verdict"] != expected:
            missed.append(f"{label}: {best['verdict']}")
    for line in missed:
        print("missed:", line)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
