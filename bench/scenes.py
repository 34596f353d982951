"""Collision questions with a known answer, as SMT-LIB 2: two bodies share a point.

A gap above 0 makes a question unsatisfiable, below 0 satisfiable. The bodies and their frames are those of the motion
case studies: a rectangle and a disc, two rectangles, and the lower link of an arm on a cart against another cart.
"""
import math


def script(variables, assertions):
    lines = ["(set-logic QF_NRA)"]
    lines += [f"(declare-fun {name} () Real [{lo}, {hi}])" for name, (lo, hi) in variables.items()]
    lines += [f"(assert {a})" for a in assertions]
    return "\n".join(lines + ["(check-sat)", ""])


def in_rectangle(x, y, theta, half_length, half_width):
    """The point (px, py) in a rectangle with this pose."""
    dx, dy = f"(- px {x})", f"(- py {y})"
    along = f"(+ (* {dx} (cos {theta})) (* {dy} (sin {theta})))"
    across = f"(- (* {dy} (cos {theta})) (* {dx} (sin {theta})))"
    return [f"(<= (- {half_length}) {along} {half_length})", f"(<= (- {half_width}) {across} {half_width})"]


HALF_DIAGONAL = math.hypot(0.2, 0.1)


def disc(gap):
    """A rectangle of 0.4 m x 0.2 m, anywhere within half a metre, and a disc of radius 0.25 m."""
    centre = 0.5 + HALF_DIAGONAL + gap + 0.25
    variables = {"x": (-0.5, 0.5), "y": (-0.5, 0.5), "theta": (-3.15, 3.15), "px": (-2, 2), "py": (-2, 2)}
    return script(variables, [*in_rectangle("x", "y", "theta", 0.2, 0.1),
                              f"(<= (+ (^ (- px {centre:.12f}) 2) (^ py 2)) 0.0625)"])


def rect2(gap):
    """Two such rectangles, turning freely; the second one stays to the right of the first."""
    left = 0.5 + 2 * HALF_DIAGONAL + gap
    variables = {"x1": (-0.5, 0.5), "y1": (-0.5, 0.5), "a1": (-3.15, 3.15), "x2": (f"{left:.12f}", f"{left + 0.5:.12f}"),
                 "y2": (-0.5, 0.5), "a2": (-3.15, 3.15), "px": (-2, 2), "py": (-2, 2)}
    return script(variables, [*in_rectangle("x1", "y1", "a1", 0.2, 0.1), *in_rectangle("x2", "y2", "a2", 0.2, 0.1)])


def free2(gap):
    """Two such rectangles anywhere, their centres apart by more than both half diagonals: no direction is special."""
    apart = 2 * HALF_DIAGONAL + gap
    variables = {"x1": (-0.5, 0.5), "y1": (-0.5, 0.5), "a1": (-3.15, 3.15), "x2": (-1.5, 1.5), "y2": (-1.5, 1.5),
                 "a2": (-3.15, 3.15), "px": (-2, 2), "py": (-2, 2)}
    return script(variables, [*in_rectangle("x1", "y1", "a1", 0.2, 0.1), *in_rectangle("x2", "y2", "a2", 0.2, 0.1),
                              f"(>= (+ (^ (- x1 x2) 2) (^ (- y1 y2) 2)) {apart * apart:.12f})"])


def arm(gap):
    """A cart (a box) and the lower link (a cylinder) of an arm with three joints on another cart, to its right.

    The gap is that of spheres around both; the arm must also reach down, so it really is 0.08 m wider.
    """
    left = 0.5 + math.hypot(0.22 + 0.10, 0.04) + math.hypot(0.09, 0.085) + gap
    variables = {"x1": (-0.5, 0.5), "y1": (-0.5, 0.5), "t1": (-3.15, 3.15), "x2": (f"{left:.12f}", f"{left + 0.5:.12f}"),
                 "y2": (-0.5, 0.5), "t2": (-3.15, 3.15),
                 "a": (-2.269, 2.269), "b": (-2.269, 2.269), "c": (-3.15, 3.15), "px": (-2, 2), "py": (-2, 2), "pz": (0, 1)}
    body = in_rectangle("x1", "y1", "t1", 0.09, 0.085) + ["(<= 0 pz 0.16)"]
    turn = lambda u, v, angle: (f"(+ (* {u} (cos {angle})) (* {v} (sin {angle})))",
                                f"(- (* {v} (cos {angle})) (* {u} (sin {angle})))")
    # Into the frame of the cart, of the turntable, of the upper and of the lower link.
    u, v = turn("(- px x2)", "(- py y2)", "t2")
    u, v = turn(u, v, "c")
    w, u = turn("(- pz 0.38)", u, "b")
    w, u = turn(f"(- {w} 0.22)", u, "a")
    link = [f"(<= 0 {w} 0.10)", f"(<= (+ (^ {u} 2) (^ {v} 2)) 0.0016)"]
    return script(variables, [*body, *link])


def quads(gap):
    """Two drones on straight paths between corners of boxes, at the same time; bodies are spheres of 0.25 m."""
    names = [f"{axis}{end}{drone}" for drone in (1, 2) for end in "pq" for axis in "xyz"]
    variables = {}
    for name in names:
        drone = int(name[-1])
        variables[name] = (0, 1) if name[0] != "y" else ((0, 1) if drone == 1 else (1.5 + gap, 2.5 + gap))
    variables["t"] = (0, 1)
    at = lambda axis, d: f"(+ {axis}p{d} (* t (- {axis}q{d} {axis}p{d})))"
    square = " ".join(f"(^ (- {at(axis, 1)} {at(axis, 2)}) 2)" for axis in "xyz")
    return script(variables, [f"(<= (+ {square}) 0.25)"])


FAMILIES = [("disc", disc, (0.1, 0.05, 0.01, -0.05)), ("rect2", rect2, (0.1, 0.05, 0.02, 0.005, -0.05)), ("free2", free2, (0.3,)),
            ("arm", arm, (0.2, 0.1, 0.05, 0.02, -0.2)), ("quads", quads, (0.3, 0.1, -1.2))]
