#!/usr/bin/env python3
"""The published choreographies in their original form get the verdicts that the rules of the paper give them.

  published.py RONDO FOLDER

FOLDER holds the texts of the artifact: fetch.chor, handover.chor, twist.chor, underpass.chor, sorting.chor, lanes_par.chor and
lanes_nopar.chor (two carts). They are not part of this project. Prints, without and with `equal_durations`, which rules reject
each, and how long that takes; those that are accepted are proved, with the contracts that they state. Twist cannot be: between its
regions lies the surface of a cylinder, `x^2 + y^2 == 0.35^2`, which belongs to none of them and through which the arm reaches. Joints
may turn a degree further than the artifact says, since its 2.2689280275926285 rad is a little more than 130 degrees.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
UNDERPASS = "Cart.x == 0 and Cart.y == 0 and Cart.theta == 0"
WORLDS = {
    "fetch": "C: Cart  A: Moveo(limit = 131 deg) on C.top",
    "handover": "Cart: Cart  Arm: Moveo(limit = 131 deg) on Cart.top  Carrier: Carrier at translate(1.15 m, 0, 0) * rotate_z(180 deg)",
    "twist": "Cart: Cart  Arm: Moveo(limit = 131 deg) on Cart.top  Carrier: Carrier at translate(0.5 m, 0, 0) * rotate_z(180 deg)",
    "underpass": "obstacle pillar: box(translate(-0.5 m, 0.5 m, 0) * rotate_z(45 deg), (0, 0, 0), (0.1 m, 0.3 m, 0.2 m))\n"
                 "obstacle bridge: box(translate(-0.5 m, 0.5 m, 0.2 m) * rotate_z(45 deg), (0, 0, 0), (0.3 m, 0.03 m, 0.1 m))\n"
                 "Cart: Cart at rotate_z(90 deg)  Arm: Moveo(limit = 131 deg) on Cart.top  Carrier: Carrier at translate(-1.1 m, 0.09 m, 0)",
    "sorting": "arm: Moveo(a_ref = -130 deg, b_ref = 130 deg) at (0, 0.7 m, 0.18 m)  carrier: Carrier at (-0.6 m, 0, 0)\n"
               "franka: Panda at translate(-0.2 m, -1.1 m, 0) * rotate_z(90 deg)  producer: Producer at (-0.95 m, 0, 0)\n"
               "sensor: Sensor at (0.15 m, -0.05 m, 0)",
    "lanes_par": "Cart0: Cart  Cart1: Cart at (0, 0.65 m, 0)",
    "lanes_nopar": "Cart0: Cart  Cart1: Cart at (0, 0.65 m, 0)",
}
CONTRACTS = (f"contract CartContract {{ guarantee {UNDERPASS} }}\ncontract ArmContract {{ assume {UNDERPASS} }}\n"
             f"contract ArmCarrierContract {{ assume {UNDERPASS} }}\n")
CHAIN, RIGID, READY = "choreo-motion-after-motion", "choreo-two-noninterruptible", "choreo-not-ready"
EXPECTED = {
    "fetch": (set(), set()),
    "handover": ({READY, CHAIN}, {CHAIN}),
    "twist": ({RIGID, READY}, set()),
    "underpass": ({READY}, set()),
    "sorting": ({RIGID, CHAIN}, {RIGID, CHAIN}),
    "lanes_par": (set(), set()),
    "lanes_nopar": ({RIGID, CHAIN}, set()),
}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rondo, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    wrong = 0
    with tempfile.TemporaryDirectory() as work:
        world = pathlib.Path(work) / "world.rondo"
        for name, robots in WORLDS.items():
            models = "".join(f'import "{m}"\n' for m in sorted((ROOT / "models").glob("*.rondo")))
            world.write_text(f"{models}world W {{ {robots} }}\n{CONTRACTS if name == 'underpass' else ''}")
            for option, wanted in zip(([], ["--option", "equal_durations"]), EXPECTED[name]):
                start = time.perf_counter()
                done = subprocess.run([rondo, "check", "--json", *option, world, folder / f"{name}.chor"], capture_output=True,
                                      text=True, check=False)
                took = time.perf_counter() - start
                kinds = {d["kind"] for d in json.loads(done.stdout)["diagnostics"]}
                wrong += kinds != wanted
                verdict = ", ".join(sorted(kinds)) or "accepted"
                print(f"{name:12} {option[1] if option else '':16} {took * 1000:6.1f} ms  {verdict}"
                      f"{'' if kinds == wanted else '   EXPECTED ' + str(sorted(wanted))}")
                if kinds:
                    continue
                start = time.perf_counter()
                done = subprocess.run([rondo, "prove", "--json", "--no-cache", *option, world, folder / f"{name}.chor"],
                                      capture_output=True, text=True, check=False)
                took = time.perf_counter() - start
                proofs = [o for o in json.loads(done.stdout)["choreographies"][0]["obligations"] if o["required"]]
                good = sum(o["verdict"] == "proved" for o in proofs)
                expected = len(proofs) - (name == "twist")
                wrong += good != expected
                print(f"{'':12} {'prove':16} {took * 1000:6.0f} ms  {good} of {len(proofs)} obligations proved"
                      f"{'' if good == expected else '   EXPECTED ' + str(expected)}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
