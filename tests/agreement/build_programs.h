#pragma once

#include <string_view>

/// Programs that together use everything that the language has.
namespace rondo::koord {

inline constexpr std::string_view kBuildPrograms[] = {
    // Numbers of both kinds, and points.
    R"(
param int big = 9223372036854775807
param float half = 0.5
allread:
    int x[N_sys] = 0
    float y[N_sys] = 0
allwrite:
    float total = 0
    pos centre = pos(0, 0, 0)
local:
    int a = 0
    int b = 1
    float f = 0
    float g = 1
    pos p = pos(0, 0, 0)
    pos q = pos(1, 2, 3)
    bool ok = true
Whole:
    pre: a + b < big - 1 or ok
    eff:
        x[pid] = a * b - a / b + a % b
        a = abs(a - b) + abs(-a)
        b = -b
        a += 3
        b++
        a = min(a, b, 3) + max(a, b)
Float:
    pre: f <= g or f != g and g > half
    eff:
        y[pid] = f * g + f / g - g
        f = sqrt(f) + hypot(f, g) + abs(-f)
        g = -(f - g) + half
        g += 1
        f = min(f, g) + max(f, 2 * a, g) + mid([f, g]) + dist([f, g]) + a
        total = f if g > 0 else a
Rounding:
    pre: floor(f) <= ceil(g) and round(f) >= sign(g)
    eff:
        a = floor(f) + ceil(g) * round(f + g) - sign(f) + sign(a) + floor(a)
        b = 7 if ok else 1
Points:
    pre: dist(p, q) < 100 and (p in rect(pos(0, 0, 0), pos(5, 5, 5)) or p == q)
    eff:
        p = p + q - p * 2 + p / 3 + p / f + mid([p, q])
        q = -q + p
        q = q / a
        centre = pos(p.x, q.y) if ok else p
        p.x = f
        q.z = p.x + q.y
        ok = p not in rect(q, p) or not (a in ID)
Several:
    pre: (a / b) + (b / a) > (a % b) * (b % a) and x[a] == x[b] and y[a] >= y[b]
    eff:
        ok = (a / b) <= (b / a) and (f / g) == (g / f)
        x[pid] = x[a] + x[b] * x[a + 1]
        y[pid] = min(f / g, g / f) + max(sqrt(f), sqrt(g))
Zero:
    pre: f == 0
    eff:
        y[pid] = -f
invariant range: forall i in ID: x[i] <= 10 and a[i] / b[i] >= 0
invariant float: forall i in ID: f[i] == g[i] implies sqrt(f[i]) <= y[i]
invariant near: forall i, j in ID: dist(p[i], p[j]) <= 4 or p[i] != q[j]
)",
    // Arrays, records, tuples, lists, and lists of them.
    R"(
def Mode {idle, busy, lost}
def adt Item:
    int id
    pos place
    Mode mode
def adt Box:
    int k[2]
    List<Item> items
param int rows = 2
param Item first = Item(3, pos(1, 0, 0), lost)
param List<int> primes = [2, 3, 5]
param float weights[3] = [1, 0.5, -0.25]
def fun has(List<int> xs, int x) -> bool:
    for k = 0, len(xs):
        if xs[k] == x:
            return true
    return false
def fun twice(int x) -> int:
    return 2 * x + len(primes)
def fun lost_one(Item item, int x):
    if item.mode == lost:
        return item.id + twice(x)
    if x > 3:
        return x
def fun total(int[2] xs) -> int:
    return xs[0] + xs[1]
def fun last(int[3] xs) -> int:
    return xs[2]
def fun all_of(bool[4] xs) -> bool:
    return xs[0] and xs[3]
def fun own(int x) -> int:
    return x + count[pid] + pid
allread:
    int count[N_sys] = 0
    List<pos> trail[N_sys]
    int pair[N_sys][2]
allwrite:
    int c[3]
    int g[2][3]
    int cube[2][2][2]
    List<Item> todo
    Queue<int> line
    Mode mode
local:
    Item item
    Box box
    List<int> l
    List<List<int>> ll
    List<int, bool> pairs
    Item other
    bool seen[4]
    int deep[2][2]
    Mode mine
Cells:
    pre: c[count[pid]] >= 0 or g[0][count[pid]] == g[count[pid]][1]
    eff:
        c[0] = c[1] + primes[0]
        c[count[pid]] += 1
        g[1][item.id] = c[2]
        g[count[pid]] = g[0]
        g = [[1, 2, 3], [4, 5, 6]]
        c = [1, 2, item.id]
        cube[0][item.id] = cube[1][0]
        cube[item.id][count[pid]][1] = cube[0][count[pid]][item.id]
        seen[item.id] = has(l, 2)
        deep[item.id][1] = deep[0][0] + floor(weights[0])
        deep = [[1, 2], [3, item.id]]
        deep[0] = deep[1]
        pair[pid][item.id] = pair[pid][0] + 1
        count[pid] = own(2) + lost_one(item, 1) + len(line)
Records:
    pre: item.mode != mode or len(pairs) > 1 or first == item
    eff:
        item = Item(pairs[0].first, pos(1, 2, 3), busy)
        item.id = todo[0].id
        item.place.x = 2
        box.k[item.id] = 3
        box.k = [1, item.id]
        box.items = todo
        box.items[item.id].id += 1
        box.items[0].mode = mine
        todo[item.id] = item
        todo[0].place = trail[pid][0]
        pairs = [(item.id, true), pairs[0]]
        pairs.append((count[pid], pairs[0].second))
        mode = mine
        mine = lost if mine == idle else idle
Lists:
    pre: len(l) >= 0 and (exists m in l: m > 1) and (forall i in todo: i.id >= 0)
    eff:
        l.append(l[0])
        l.insert(item.id, 4)
        l.remove(4)
        l.pop(item.id)
        l.pop(0)
        ll.append(l)
        ll[0].append(len(ll))
        ll[item.id][0] = 5
        l = l[1:]
Removing:
    pre: total(deep[0]) >= last(c) and all_of(seen)
    eff:
        l.remove(2)
        total(deep[1])
        todo.remove(item)
        box.k = deep[item.id]
Changes:
    pre: 2 in l and 3 not in l or l.contains(7) or l == []
    eff:
        ll = [l, [1], []]
        l = ll[0][0:1]
        l = l[item.id:]
        line.pop()
        line.append(line.front())
        todo.clear()
        trail[pid].append(pos(1, 0, 0))
        trail[pid] = [pos(0, 0, 0), mid([pos(0, 0, 0), item.place])]
        for t in todo:
            todo.append(t)
            l.append(t.id)
        for t in l:
            if t == 2:
                continue
            if t > 3:
                break
            l.append(t + 1)
        for i = 0, len(l):
            count[pid] += l[i]
        for i = l[0], l[1]:
            count[pid] = i
Quantified:
    pre: forall i in ID: count[i] >= 0 or mode == mine
    eff:
        mine = idle if (exists i in ID: count[i] > 1 and trail[i] == trail[pid]) else lost
        count[pid] = (sum i in ID: count[i]) + (count i in ID: len(trail[i]) > 0)
        count[pid] = (min i in ID: count[i]) + (max i in ID: count[i] - i)
        item.id = (argmin i in ID: count[i]) + (argmax i in ID: pair[i][0])
        item.place = sum i in ID: item.place
        other.id = 1 if (forall k in range(len(l)): l[k] > 0 and (exists j in range(k, len(l)): l[j] == l[k] + item.id)) else 2
Choices:
    pre: true
    eff:
        count[pid] = any int in 0..2
        item.id = any q in [1, count[pid], 4]
        atomic:
            c[1] = any q in l
            item = any t in todo
invariant limits: forall i in ID: exists k in int: 0 <= k and k <= 2 and len(l[i]) == k
invariant modes: forall i in ID, b in bool, m in Mode: count[i] >= 0 or b or m == mode or mine[i] == m
invariant lists: forall i in ID: forall k in range(len(l[i])): l[i][k] < 5
invariant boxes: forall i in ID: box[i].k[0] <= box[i].k[1] or stopped[i]
invariant mine: forall i in ID, k in int: 0 <= k and k < len(trail[i]) implies trail[i][k] == trail[i][0]
)",
    // Statements: loops that do not end in time, functions without a value, stops, what is said, urgent events and locks.
    R"(
def fun root(float x) -> float:
    if x < 0:
        return
    return sqrt(x)
def fun steps(int n) -> int:
    int k = 0
    int i = n
    while i > 0 within 3:
        i -= 1
        k += i
    return k
allwrite:
    int s = 0
    int t = 0
allread:
    bool up[N_sys] = false
local:
    int n = 0
    float x = 1
    string word = "none"
    stream out
init:
    n = pid
    s = n + 1
    out << "begins " << n
init:
    s = s + n
    up[pid] = n > 1
Loop:
    pre: n < 4
    eff:
        int v = n
        while v < 5 within s:
            v += 1
            if v == 2:
                continue
            if v == 4:
                break
            t = v
        for k = 0, 3:
            int k2 = k * k
            v -= k2
        n = steps(v)
        x = root(v)
Say:
    pre: n >= 0 and word != "stop"
    eff:
        word = "n is " + n + ", x is " + x
        word += "!"
        out << word << n << x << up[pid] << "a \"b\"\n"
        if word == "n is 1, x is 1!":
            word = "none"
        elif n > 2:
            word = "stop"
        else:
            out << (n, x)
Urgent:
    pre urgent: up[pid] and n > 1
    eff:
        atomic:
            up[pid] = false
            s = n
Both:
    pre urgent: 4 / n > 1 and not up[pid]
    eff:
        t = t + 1
        if t > 3:
            stop
        atomic:
            s = t
            return
        s = 0
Last:
    pre: n < 6
    eff:
        n = n + 1
invariant small: s <= 4 and t <= 4
invariant said: forall i in ID: word[i] != "stop" or n[i] > 2
response back: up[pid] within 3 rounds not up[pid]
)",
    // Ports, functions of the world, fallbacks, external types.
    R"(
using Motion:
    sensors:
        pos psn
        bool reached
        PathPlanner planner
    actuators:
        List<pos> path
        pos target
using Arm:
    sensors:
        Grid seen
        List<pos, Grid> scans
    actuators:
        float grip
def fun clear(List<pos>[N_sys] paths, List<pos> path) -> bool
def fun merge(Grid a, Grid b) -> Grid
def fun drawn(pos p, Grid g) -> Grid
def fun cost(pos p, int k) -> float
allread:
    List<pos> paths[N_sys]
allwrite:
    Grid map
local:
    Grid own
    List<pos> plan
    float best = 0
Plan:
    pre: not Motion.reached or cost(Motion.psn, pid) < 1
    eff:
        plan = Motion.planner(Motion.psn)
        if clear(paths, plan):
            paths[pid] = plan
            Motion.path = plan
            Motion.target = plan[0]
        best = cost(Motion.psn, 1) + cost(plan[0], 2) + min(cost(Motion.psn, 3), best)
Draw:
    pre: own != map
    eff:
        for p, s in Arm.scans:
            own = merge(own, drawn(p, s))
        atomic:
            map = merge(map, own)
        Arm.grip = best + 0.5
        Motion.path = plan
fallback Motion:
    target = psn
    path = [psn, mid([psn, psn])]
fallback Arm:
    grip = 1 / len(scans)
assume Motion.stays when Motion.reached always dist(Motion.psn, old(Motion.psn)) <= 1
assume Motion.ends when Motion.target == Motion.psn finally Motion.reached or cost(old(Motion.target), pid) > 0
assume Arm.sees when Arm.grip > 1 always Arm.seen == old(Arm.seen)
assume Motion.lies always Motion.psn.z == 0
assume initially: len(Motion.path) == 1 and paths[pid] == Motion.path
invariant apart: forall i, j in ID: i != j implies dist(Motion[i].psn, Motion[j].psn) > 1
invariant told: forall i in ID: Motion[i].path == paths[i] and Arm[i].grip >= 0
)",
    // Names that C++, or what is made, has already.
    R"(
def adt Task:
    int Members
    bool new
def adt Self:
    int new_
    Task Core
using Motion:
    actuators:
        int target
param string names[2] = ["a\\b", "c ??/ d"]
param int NULL = 3
def fun shorter(List<int> l, Task t) -> int:
    l.append(3)
    t.Members = len(l)
    return t.Members - -1
allread:
    int x[N_sys] = 0
    int new_x[N_sys] = 0
allwrite:
    int shared = 0
    int x_item[2]
    int kCount = 0
local:
    int Motion_target = 0
    int effect = 0
    int me = 0
    int out = 0
    Task task
    Self self
    List<int> double
    int int64_t = 0
    int r = 0
    string log
Task:
    pre: x[pid] < 3 and x[pid] != - -4
    eff:
        int i_2 = 100
        int i_end = 2
        int items_at = 7
        int most = 4
        int v = 0
        for i = 0, i_end:
            v += i_2
        for i = 0, i_end:
            v += i_2 + i
        for q in double:
            v += items_at
        while v < 900 within 9:
            v += most
        x[pid] = v + 10
        new_x[pid] = new_x[pid] + -(-1)
        x_item[0] = shorter(double, task)
        log = names[1] + "\\" + names[0]
event_Task:
    pre: r < NULL
    eff:
        Motion.target = 3
        Motion_target = 4
        effect = effect + 1
        me = effect
        out = me
        shared = out
        kCount = shared
        task = Task(1, true)
        self = Self(2, task)
        self.Core.Members = self.new_
        int64_t = 3
        r = r + 1
        double.append(r)
invariant Task: forall i in ID: Motion_target[i] <= 4 and x[i] >= 0
)",
};

}  // namespace rondo::koord
