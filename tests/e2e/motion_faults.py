"""Faults in the choreographies among the examples, and how to write one of them."""
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "examples/choreo"

# Name, example, what is replaced by what, the kind that has to be reported.
FAULTS = [
    ("the carrier drives too far", "handover", "carrier: MoveCart(0, 0, 0, 0.5 m, 5 s)", "carrier: MoveCart(0, 0, 0, 0.65 m, 5 s)", "choreo-region"),
    ("both drive too far, together", "handover", "thread region x > 0.558 m { carrier: MoveCart(0, 0, 0, 0.5 m, 5 s) carrier: Idle() }", "thread region x > 0.558 m { carrier: MoveCart(0, 0, 90 deg, 0.5 m, 5 s) carrier: Idle() }", "choreo-precondition"),
    ("a region too small", "fetch", "cylinder(translate(2 m, 0, 0), 0.26 m", "cylinder(translate(2 m, 0, 0), 0.20 m", "choreo-region"),
    ("regions that overlap", "fetch", "not in cylinder(translate(2 m, 0, 0), 0.27 m", "not in cylinder(translate(2 m, 0, 0), 0.25 m", "choreo-region"),
    ("a wrong start", "fetch", "cart: MoveFromTo(point(0, 0, 0), point(2 m, 0, 0), 0)", "cart: MoveFromTo(point(0.5 m, 0, 0), point(2 m, 0, 0), 0)", "choreo-precondition"),
    ("guards that are not total", "producer", "when sensor.colour <= 0.5", "when sensor.colour <= 0.4", "choreo-no-alternative"),
    ("lanes too close", "lanes4", "at (0, 650 mm, 0)", "at (0, 400 mm, 0)", "choreo-region"),
    ("a wrong angle", "twist", "arm: Rotate(0, 120 deg - 0.35 rad,", "arm: Rotate(0, 120 deg - 0.30 rad,", "choreo-precondition"),
    ("a circle too small", "twist", "Swipe(0, 0, 0, 0.5 m,", "Swipe(0, 0, 0, 0.3 m,", "choreo-region"),
    ("a leg at another angle", "underpass", "carrier: MoveCart(0.67 m, 0, 45 deg, 0.5 m)", "carrier: MoveCart(0.67 m, 0, 60 deg, 0.5 m)", "choreo-precondition"),
    ("into the pillar", "underpass", "box(translate(-0.5 m, 0.5 m, 0) *", "box(translate(-0.3 m, 0.15 m, 0) *", "choreo-collision"),
    ("into the sensor", "sorting", "carrier: MoveCart(0, 0, 0, 0.5 m)", "carrier: MoveCart(0, 0, 0, 0.7 m)", "choreo-region"),
    ("a wrong argument in a process", "handover", "\n  MoveCart(0, 0, 0, 0.5 m, 5 s)\n", "\n  MoveCart(0, 0, 0, 0.4 m, 5 s)\n", "process-argument"),
    ("a message that is missing", "handover", "\n  send carrier.taken()\n", "\n", "process-step"),
    ("a guard of a process that is too strong", "fetch", "while dist((x, y), (0, 0)) > 0.1 m { MoveFromTo(point(2 m", "while dist((x, y), (0, 0)) > 2.5 m { MoveFromTo(point(2 m", "process-condition"),
    ("an arm that stands too low", "first", "cylinder(self, 10 cm, 15 cm, 40 cm)", "cylinder(self, 25 cm, 5 cm, 40 cm)", "choreo-collision"),
    ("a cart that turns into the arm", "first", "cart: Move(0, 1 m)", "cart: Move(0, 1.3 m)", "choreo-precondition"),
    ("an arm that reaches too low", "shuttle", "translate(0, 0, 30 cm) * rotate_z(a)", "translate(0, 0, 10 cm) * rotate_z(a) * translate(20 cm, 0, 0)", "choreo-collision"),
    ("a contract that cannot be kept", "shuttle", "post x == to and y == 0", "post x == to and y == 1 m", "choreo-contract"),
    ("a body larger than its footprint", "lanes4", "inner = 150 mm, outer = 250 mm", "inner = 350 mm, outer = 350 mm", "choreo-region"),
]


def stage(folder):
    """Makes a folder where faulty examples find the models that they import; where they go."""
    (pathlib.Path(folder) / "models").symlink_to(ROOT / "models")
    place = pathlib.Path(folder) / "examples/choreo"
    place.mkdir(parents=True)
    return place


def faulty(example, old, new, kind):
    """The text of an example with a fault; nothing if there is nothing to replace."""
    text = (EXAMPLES / f"{example}.rondo").read_text()
    if old not in text:  # in a model
        text = re.sub(r'import "../../models/(.*)"\n', lambda m: (ROOT / "models" / m.group(1)).read_text(), text)
    if old not in text:
        return None
    text = text.replace(old, new)
    return text if kind.startswith("process-") else text.split("\nprocess ")[0] + "\n"
