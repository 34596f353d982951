#!/usr/bin/env python3
"""Writes the mutants beside this file: each example with one fault that must keep it from being proved.

Run it again after a change of an example; the test `mutants` fails when they are out of date.
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parent.parent / "examples/koord"

# name: (example, [(text, replacement)], what is wrong)
MUTANTS = {
    "lineform_no_promise": ("lineform", [
        ("assume Motion.stays_in_box when Motion.psn in rect(a, b) and Motion.target in rect(a, b)\n"
         "    always Motion.psn in rect(a, b)\n", "")], "no controller assumption"),
    "lineform_no_targets": ("lineform", [
        ("invariant targets: forall i in ID: Motion[i].target in rect(a, b)\n", "")], "the ends keep unknown targets"),
    "lineform_sum": ("lineform", [("mid([x[pid + 1], x[pid - 1]])", "x[pid + 1] + x[pid - 1]")], "a sum is no midpoint"),
    "lineform_index": ("lineform", [("if not (pid == N_sys - 1 or pid == 0):", "if not (pid == 0):")],
                       "the last robot has no right neighbour"),
    "delivery_no_summary": ("delivery", [
        ("summary pathIsClear(sp, cp, i) -> y: forall j in ID: j != i and apart(sp[j], cp) <= rho implies not y\n", "")],
        "nothing is known of pathIsClear"),
    "delivery_no_atomic": ("delivery", [("            atomic:\n", "            if true:\n")], "two robots take tasks in one round"),
    "delivery_margin": ("delivery", [("rho >= 2 * beta + epsilon", "rho >= beta + epsilon")], "the margin is too small"),
    "delivery_no_tracking": ("delivery", [
        ("assume Motion.tracks when away(Motion.psn, Motion.path) <= beta\n    always away(Motion.psn, Motion.path) <= beta\n", "")],
        "the controller may leave its path"),
    "delivery_drift": ("delivery", [
        ("    always away(Motion.psn, Motion.path) <= hold\n", "    always away(Motion.psn, Motion.path) <= beta\n")],
        "parked robots drift"),
    "delivery_no_remove": ("delivery", [("                    all_tasks.remove(cur_task)\n", "")], "a task stays in the list"),
    "delivery_no_start": ("delivery", [
        ("assume Motion.plans always forall q in pos: away(Motion.psn, Motion.planner(q)) == 0\n", "")],
        "a path may start anywhere"),
    "mapping_overwrites": ("mapping", [
        ("summary merge(a, b) -> g: right(a) and right(b) implies right(g)\n", "summary merge(a, b) -> g: right(g) implies right(a)\n")],
        "merge may write anything over a map"),
    "mapping_unsound_scan": ("mapping", [
        ("assume MotionWithScan.sound always forall e in MotionWithScan.pscan: true_scan(e.first, e.second)\n", "")],
        "scans may be wrong"),
    "mapping_too_many_scans": ("mapping", [("always len(MotionWithScan.pscan) <= 2", "always len(MotionWithScan.pscan) <= 2 or true")],
                               "the loop is longer than it was unrolled"),
    "mutex_not_exclusive": ("mutex", [("    pre: forall j in ID: not inside[j]\n", "    pre: not inside[pid]\n")], "nobody looks"),
    "leader_no_atomic": ("leader", [("        atomic:\n            if pid > candidate:", "        if true:\n            if pid > candidate:")],
                         "the last writer wins"),
    "hvac_not_urgent": ("hvac", [("pre urgent: true", "pre: true")], "the heater may be left on"),
    "hvac_drift": ("hvac", [("drift <= 1", "drift <= 3")], "the room drifts faster than the heater"),
    "shapeform_strange_neighbour": ("shapeform", [("summary left(i) -> j: j in ID\n", "")], "the neighbour may be nobody"),
    "addnums_no_atomic": ("addnums", [("        atomic:\n            sum = sum + pid * 2", "        if true:\n            sum = sum - pid * 2")],
                          "the sum shrinks"),
    "platoon_no_gap": ("platoon", [("at[pid - 1] - gap", "at[pid - 1]")], "up to where the one before it was"),
    "platoon_backwards": ("platoon", [("always old(Motion.psn.x) <= Motion.psn.x and Motion.psn.x", "always Motion.psn.x")],
                          "the one before may drive backwards"),
    "coverage_no_atomic": ("coverage", [("        atomic:\n            int next", "        if true:\n            int next")],
                           "two claim the same cell"),
    "consensus_no_atomic": ("consensus", [("        atomic:\n            if decision", "        if true:\n            if decision")],
                            "two decide in one round"),
    "auction_dearest": ("auction", [("argmin i in ID", "argmax i in ID")], "the dearest wins"),
    "auction_too_soon": ("auction", [(" and (forall i in ID: bidding[i])\n    eff:\n        atomic:\n            winner = argmin",
                                      "\n    eff:\n        atomic:\n            winner = argmin")], "somebody has not bid yet"),
    "warehouse_no_atomic": ("warehouse", [("        atomic:\n            order[pid]", "        if true:\n            order[pid]")],
                            "two take one order"),
    "warehouse_no_pop": ("warehouse", [("            orders.pop()\n", "")], "an order stays in the queue"),
    "warehouse_occupied": ("warehouse", [("                if not taken[k]:\n", "                if true:\n")], "a dock that is taken"),
    "warehouse_twice": ("warehouse", [("assume initially: forall a, b in range(len(orders)): a != b implies orders[a].id != orders[b].id\n", "")],
                        "two orders with one number"),
}


def texts():
    for name, (example, changes, what) in MUTANTS.items():
        program = (EXAMPLES / f"{example}.koord").read_text()
        spec_path = EXAMPLES / f"{example}.spec"
        spec = spec_path.read_text() if spec_path.exists() else ""
        for old, new in changes:
            if program.count(old) + spec.count(old) != 1:
                raise SystemExit(f"{name}: `{old.strip()}` stands {program.count(old) + spec.count(old)} times in {example}")
            program, spec = program.replace(old, new), spec.replace(old, new)
        body = program + ("\n" + spec if spec else "")
        lines = [line for line in body.split("\n") if not line.startswith("# expect:")]
        yield HERE / f"{name}.koord", f"# A mutant of {example}: {what}. Must not be proved.\n" + "\n".join(lines)


def main():
    stale = 0
    for path, text in texts():
        if path.exists() and path.read_text() == text:
            continue
        stale += 1
        if "--check" in sys.argv:
            print(f"{path.name} is out of date: run tests/mutants/make.py")
        else:
            path.write_text(text)
    print(f"{len(MUTANTS)} mutants, {stale} {'stale' if '--check' in sys.argv else 'written'}")
    return 1 if stale and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
