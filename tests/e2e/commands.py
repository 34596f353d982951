#!/usr/bin/env python3
"""The command line as people use it: exit statuses, missing files, help, completion, cache, files written, Ctrl-C.

  commands.py RONDO
"""
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from xml.etree import ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
FOLDER = pathlib.Path(tempfile.mkdtemp())
ENV = {**os.environ, "XDG_CACHE_HOME": str(FOLDER / "cache"), "NO_COLOR": "1"}
results = {"passed": 0, "failed": 0}


def rondo(*args, **more):
    return subprocess.run([RONDO, *args], cwd=ROOT, capture_output=True, text=True, timeout=300, env=ENV, **more)


def check(name, good, detail=""):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}: {detail}")


LINEFORM = "examples/koord/lineform.koord"

# Every verb has a help with an example, and says so in the list of verbs.
help_text = rondo("--help").stdout
VERBS = re.findall(r"^  ([a-z]+) +\S", help_text.split("Subcommands:")[1], re.MULTILINE)
check("verbs", {"check", "prove", "explore", "reach", "replay"} <= set(VERBS), help_text)
for args in (["--help"], ["infer", "regions", "--help"], *([verb, "--help"] for verb in VERBS if verb != "infer")):
    done = rondo(*args)
    check(f"{args}", done.returncode == 0 and "example" in done.stdout, done.stdout + done.stderr)
for args in ([], ["nonsense"], ["prove"], ["prove", LINEFORM, "--robots", "0"], ["explain", "koord-nonsense"]):
    done = rondo(*args)
    check(f"usage {args}", done.returncode == 2, f"status {done.returncode}")
check("suggestion", "koord-arity" in rondo("explain", "koord-arty").stderr)

done = rondo("prove", "missing.koord")
check("missing file", done.returncode == 1 and "cannot read `missing.koord`: no such file" in done.stderr, done.stderr)
done = rondo("check", "examples")
check("folder", done.returncode == 1 and "is a folder" in done.stderr, done.stderr)

# Exit statuses.
check("proved", rondo("prove", LINEFORM).returncode == 0)
check("refuted", rondo("prove", "examples/koord/mutex_naive.koord").returncode == 1)
unknown = rondo("prove", "--no-cache", "tests/mutants/delivery_no_remove.koord", "--timeout", "1")
check("unknown", unknown.returncode == 3 and re.search("^unknown: ", unknown.stdout, re.M), unknown.stdout[-500:])

# SMT-LIB scripts: expected answers, several files, engines compared, models, what is too hard, what is wrong.
SCRIPTS = sorted((ROOT / "examples/smt").glob("*.smt2"))
for script in SCRIPTS:
    wanted = script.read_text().split("; expect: ")[1].split("\n")[0].split()
    for extra in ([], ["--solver", "icp", "--jobs", "1"], ["--no-lemmas", "--timeout", "5"]):
        done = rondo("solve", "--json", *extra, str(script))
        answers = [a["answer"] for a in json.loads(done.stdout)["files"][0]["answers"]]
        good = answers == wanted and done.returncode == 0
        check(f"solve {script.name} {extra}", good or ("--no-lemmas" in extra and done.returncode == 3), done.stdout)
done = rondo("solve", *map(str, SCRIPTS))
check("solve several", done.returncode == 0 and "levels.smt2: sat" in done.stdout, done.stdout + done.stderr)
polynomial = FOLDER / "polynomial.smt2"
polynomial.write_text("(declare-fun x () Real [0, 2])(assert (= (* x x) 2))(check-sat)(get-model)")
done = rondo("solve", "--compare", str(polynomial))
check("solve by two engines", done.returncode == 0 and done.stdout.startswith("sat"), done.stdout)
done = rondo("solve", "--solver", "icp", "--model", str(polynomial))
check("a solution near", "a solution exists" in done.stdout and "define-fun x" in done.stdout, done.stdout)
identity = FOLDER / "identity.smt2"
identity.write_text("(declare-fun x () Real [0, 1])(assert (> (sin (* 2 x)) (* 2 (sin x) (cos x))))(check-sat)")
check("undecided", rondo("solve", "--solver", "icp", str(identity)).returncode == 3)
done = rondo("solve", "--solver", "no-such-solver", str(polynomial))
check("a solver that is not there", done.returncode == 3 and "no-such-solver" in done.stdout, done.stdout + done.stderr)
check("no script", rondo("solve", "missing.smt2").returncode == 1)

# Choreographies: the examples get the verdict that their first line states, and have projections; their generator works; a robot that is not there; a file that is not.
for example in sorted((ROOT / "examples/choreo").glob("*.rondo")):
    wanted = example.read_text().split("\n", 1)[0].removeprefix("# check: ").split()
    done = rondo("check", "--json", str(example))
    found = {d["kind"] for d in json.loads(done.stdout)["diagnostics"]}
    check(f"check {example.name}", found == set(wanted) - {"ok"} and (done.returncode == 0) == (wanted == ["ok"]), done.stdout)
    if wanted != ["ok"]:
        continue
    done = rondo("project", "--json", str(example))
    check(f"project {example.name}", done.returncode == 0 and len(json.loads(done.stdout)["types"]) >= 2, done.stdout)
for models in sorted((ROOT / "models").glob("*.rondo")):
    done = rondo("check", str(models))
    check(f"check {models.name}", done.returncode == 0 and done.stdout + done.stderr == "", done.stdout + done.stderr)
for arguments in (["3"], ["2", "3"], ["3", "2", "--together"]):
    lanes = FOLDER / "examples" / "choreo" / "lanes.rondo"
    lanes.parent.mkdir(parents=True, exist_ok=True)
    done = subprocess.run([sys.executable, ROOT / "examples/choreo/lanes.py", *arguments], capture_output=True, text=True)
    lanes.write_text(done.stdout.replace("../../models", str(ROOT / "models")))
    done = rondo("check", str(lanes))
    check(f"lanes {arguments}", done.returncode == 0 and done.stdout + done.stderr == "", done.stdout + done.stderr)
shuttle = "examples/choreo/shuttle.rondo"
done = rondo("project", shuttle, "green")
check("project one robot", "receive cart.arrive" in done.stdout and "green in Shuttle" in done.stdout, done.stdout)
done = rondo("project", shuttle, "gren")
check("project nobody", done.returncode == 1 and "did you mean `green`" in done.stderr, done.stderr)
check("project nothing", rondo("project", "missing.rondo").returncode == 1)
picture = FOLDER / "picture.svg"
done = rondo("graph", shuttle, "--svg", str(picture))
check("a chart", done.returncode == 0 and "again from 1" in picture.read_text(), done.stdout + done.stderr)
ElementTree.parse(picture)
done = rondo("project", shuttle, "green", "--svg", str(picture))
check("an automaton", done.returncode == 0 and "receive cart.arrive" in picture.read_text(), done.stdout + done.stderr)
ElementTree.parse(picture)
empty = FOLDER / "empty.rondo"
empty.write_text("world W {}\nchoreography C in W { loop { } }\nrobot R {}\nworld V { a: R }\n")
check("a chart of nobody", rondo("graph", str(empty), "--svg", str(picture)).returncode == 0)
check("a picture of several", rondo("project", shuttle, "--svg", str(picture)).returncode == 2)
check("a picture nowhere", rondo("graph", shuttle, "--svg", str(FOLDER)).returncode == 1)
nodes = json.loads(rondo("graph", "--json", shuttle).stdout)["graphs"][0]["nodes"]
check("a list of nodes", {n["kind"] for n in nodes} == {"message", "motion", "choice", "merge", "fork", "join", "end"}, str(nodes))
check("no such choreography", "did you mean `Shuttle`" in rondo("graph", shuttle, "--choreography", "Shutle").stderr)
check("formatted", rondo("fmt", "--check", *map(str, (ROOT / "models").glob("*.rondo")), *map(str, (ROOT / "examples/choreo").glob("*.rondo"))).returncode == 0)
check("no formatter of the original files", "not formatted" in rondo("fmt", "--check", "src/choreo/syntax/testdata/equations/good.chor").stderr)

# Choreographies proved: cache, files, pictures, JSON that is nothing but JSON, options of the other language, Ctrl-C.
handover = "examples/choreo/handover.rondo"
check("proved motions", "proved and certified: Handover" in rondo("prove", handover).stdout)
check("cached motions", "known from the cache" in rondo("prove", handover).stdout)
done = rondo("prove", "--no-cache", "--json", "--svg", str(picture), "--smt-out", str(FOLDER / "obligations"), "--certificates", str(FOLDER / "certificates"), handover)
check("JSON of motions", json.loads(done.stdout)["status"] == 0 and "from above" in picture.read_text(), done.stdout[:300] + done.stderr)
ElementTree.parse(picture)
scripts = sorted((FOLDER / "obligations").glob("*.smt2"))
check("obligations as scripts", len(scripts) > 20 and all("set-info :status" in s.read_text() for s in scripts))
small = [s for s in scripts if "precondition" in s.name]
check("scripts are read", all(rondo("solve", "--solver", "icp", str(s)).stdout.startswith("unsat") for s in small[:3]))
certificates = sorted((FOLDER / "certificates").glob("*.cert"))
check("certificates of motions", len(certificates) > 20 and rondo("certify", *map(str, certificates[:5])).returncode == 0)
done = rondo("prove", "--no-cache", "--smt-out", "/dev/null/x", handover)
check("a folder that cannot be written", done.returncode == 1 and "cannot use the folder" in done.stderr, done.stderr)

# What was never meant as input: one message, soon, and short.
garbage = random.Random(1).randbytes(200_000)
controls = "invariant \x1b[31mred\x1b[0m: $ \x07\n"
others = {"garbage": (garbage, "is no text"), "trace": (b"\x89MCAP0\r\n" + garbage, "is an MCAP trace"), "picture": (b"\x89PNG\r\n\x1a\n" + garbage, "is a PNG picture"),
          "library": (b"\x7fELF" + garbage, "is a program or library"), "utf16": ("\ufeffinvariant".encode("utf-16-le"), "is text in UTF-16"),
          "urdf": (b'<?xml version="1.0"?>\n<robot name="a"/>\n', "is XML, such as a robot in URDF"), "json": (b'{"rondo-run": 1}\n', "is JSON")}
for name, (content, says) in others.items():
    for suffix, verb in ((".koord", "check"), (".koord", "prove"), (".koord", "simulate"), (".koord", "explore"), (".koord", "fmt"), (".rondo", "check"), (".rondo", "graph"),
                         (".rondo", "reach")):
        file = FOLDER / (name + suffix)
        file.write_bytes(content)
        (FOLDER / (name + ".toml")).write_text("[[robot]]\nmodel = \"car\"\nposition = [0, 0, 0]\n")
        done = rondo(verb, str(file))
        check(f"{verb} {file.name}", done.returncode == 1 and says in done.stderr and done.stderr.count("error") <= 3 and len(done.stderr.splitlines()) < 8,
              f"status {done.returncode} {done.stderr[:300]}")
    file = FOLDER / (name + "_fleet.toml")
    file.write_bytes(content)
    done = rondo("simulate", LINEFORM, "--fleet", str(file))
    check(f"a fleet that is {name}", done.returncode == 1 and len(done.stderr.splitlines()) < 12, done.stderr[:300])
done = rondo("explore", "models/room.rondo")
check("a choreography for a program", done.returncode == 1 and "is a file of robots and choreographies" in done.stderr, done.stderr)
done = rondo("simulate", "models/room.rondo")
check("no choreography", done.returncode == 1 and "there is no choreography to simulate" in done.stderr, done.stderr)
# What was mistyped is met with the right word.
for args, wanted in ((["kyes"], "did you mean `keys`?"), (["prvoe", "x"], "did you mean `prove`?"), (["nothing-like-it"], "there is no verb"), (["help", "simulat"], "did you mean `simulate`?"),
                     (["simulate", "x", "--sede", "3"], "`rondo simulate` has no option `--sede`; did you mean `--seed`?"), (["launch", "--durations=3"], "did you mean `--duration`?"),
                     (["keys", "x", "--otuput", "y"], "`rondo keys` has no option"), (["--versoin"], "did you mean `--version`?")):
    done = rondo(*args)
    check(f"mistyped {args}", done.returncode == 2 and wanted in done.stderr, f"{done.returncode} {done.stderr}")
done = rondo("version")
check("version", done.returncode == 0 and done.stdout == rondo("--version").stdout, done.stdout)
check("help", "simulate" in rondo("help").stdout and rondo("help", "prove").stdout == rondo("prove", "--help").stdout, rondo("help", "prove").stdout[:300])
for suffix, old, new in ((".koord", "invariant x:", "invarient x:"), (".koord", "    eff:", "    ef:"), (".koord", "local:", "locall:"), (".rondo", "robot", "robto"),
                         (".rondo", "motion", "moton"), (".rondo", "interruptible", "interuptible"), (".rondo", "world", "wolrd"), (".rondo", "choreography", "choregraphy"), (".rondo", "initially", "initialy")):
    text = ("local:\n    int n = 0\nGo:\n    pre: n < 3\n    eff:\n        if n < 2:\n            n = n + 1\ninvariant x: forall i in ID: n[i] < 3\n" if suffix == ".koord" else
            "robot R { motion Wait() interruptible [0, inf) {} }\nworld W { a: R b: R }\nchoreography C in W {\n  initially true\n  a -> b: go()\n}\n")
    file = FOLDER / ("mistyped" + suffix)
    file.write_text(text.replace(old, new))
    done = rondo("check", str(file))
    word = old.strip(" :\n").split(" ")[0]
    check(f"mistyped {new.strip()}", done.returncode == 1 and f"did you mean `{word}`?" in done.stderr, done.stderr)
# First projects: the name is that of the folder; nothing is overwritten.
for args, status, says in ((["new", str(FOLDER / "Visit"), "--template", "choreography"], 0, "rondo prove Visit.rondo"), (["new", str(FOLDER / "Visit")], 1, "already there"),
                           (["new", str(FOLDER / "9lives")], 1, "cannot be a name"), (["new", str(FOLDER / "when")], 1, "a word of the language"),
                           (["new", str(FOLDER / "x"), "--template", "nothing"], 2, "nothing not in"), (["new", "/proc/x"], 1, "cannot make")):
    done = rondo(*args)
    check(f"{args}", done.returncode == status and says in done.stdout + done.stderr, f"{done.returncode} {done.stdout}{done.stderr}")
# Text that is none of the language, long, on one line, deeply nested, with signs that terminals obey.
for name, text in (("signs", "$ % ^ ~ ` " * 20_000), ("words", "some words that mean nothing at all\n" * 5_500), ("word", "D" * 200_000), ("brackets", "(" * 200_000), ("one", "invariant x: " + "a + " * 50_000 + "a\n"),
                   ("braces", "{ } " * 50_000), ("strings", '"' * 200_000), ("indented", "".join(" " * (i % 40) + "x\n" for i in range(9_000))),
                   ("assignments", "E:\n    eff:\n" + "        nothing = nowhere\n" * 7_000), ("controls", controls * 3_000), ("numbers", "1.2.3 " * 33_000)):
    for suffix in (".koord", ".rondo", ".smt2"):
        file = FOLDER / (name + suffix)
        file.write_text(text)
        done = rondo("solve" if suffix == ".smt2" else "check", str(file))
        lines = (done.stdout + done.stderr).splitlines()
        check(f"{name}{suffix} is refused in few words", done.returncode != 0 and len(lines) <= 100 and max(map(len, lines)) < 400, f"{done.returncode} {len(lines)} {lines[:3]}"[:500])
        check(f"{name}{suffix}: terminals are not told anything", "\x1b" not in done.stderr and "\x07" not in done.stderr)
many = json.loads(rondo("check", "--json", str(FOLDER / "signs.koord")).stdout)["diagnostics"]
check("how many more is said", many[-1]["kind"] == "file-more" and len(many) == 21, many[-1])
marked = FOLDER / "marked.koord"
marked.write_bytes(b"\xef\xbb\xbf" + (ROOT / LINEFORM).read_bytes())
check("a byte order mark", rondo("check", str(marked)).returncode == 0)

# Files are written into folders that are there.
for args in (["simulate", LINEFORM, "--duration", "1", "--trace"], ["graph", handover, "--svg"]):
    path = FOLDER / "nowhere" / "file"
    done = rondo(*args, str(path))
    check(f"no folder is made for {args[-1]}", done.returncode == 1 and "there is no folder" in done.stderr and not path.parent.exists(), done.stderr)
done = rondo("prove", LINEFORM, "--cross-check", "nosuchsolver")
check("a solver that is not there", done.returncode == 1 and "cannot run `nosuchsolver`" in done.stderr, done.stderr)
for args in (["check", LINEFORM, "--json"], ["prove", LINEFORM], ["explain", "file-kind"], ["--help"], ["explore", "examples/koord/leader.koord"], ["fmt", "--stdout", LINEFORM]):
    with open("/dev/full", "w") as full:
        done = subprocess.run([RONDO, *args], cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, env=ENV, timeout=300)
    check(f"a full disk: {args}", done.returncode == 1 and "cannot write the output" in done.stderr, f"{done.returncode} {done.stderr}")
check("an option for Koord", rondo("prove", "--robots", "3", handover).returncode == 2)
check("an option for motions", rondo("prove", "--svg", "x.svg", LINEFORM).returncode == 2)
check("nothing to prove", "there is no choreography" in rondo("prove", "models/carts.rondo").stderr)
done = rondo("infer", "regions", shuttle)
check("regions", done.returncode == 0 and "thread region x < 0.8 m" in done.stdout, done.stdout + done.stderr)
check("regions as JSON", len(json.loads(rondo("infer", "regions", "--json", shuttle).stdout)["regions"]) == 8)
process = subprocess.Popen([RONDO, "prove", "--no-cache", "--jobs", "1", "examples/choreo/sorting.rondo"], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENV)
time.sleep(0.4)  # any moment will do
process.send_signal(signal.SIGINT)
stdout, stderr = process.communicate(timeout=120)
check("Ctrl-C while motions are proved", process.returncode in (0, 3, -2) and (process.returncode != 3 or "interrupted:" in stdout and "error" not in stderr), f"{process.returncode} {stdout} {stderr}")

# The cache: the second run finds the proofs; a changed program does not.
cached = rondo("prove", LINEFORM)
check("cache", "from the cache" in cached.stdout, cached.stdout)
copy = FOLDER / "copy.koord"
copy.write_text((ROOT / LINEFORM).read_text().replace("mid([x[pid + 1], x[pid - 1]])", "x[pid + 1]"))
check("cache of another program", rondo("prove", str(copy)).returncode == 0)
copy.write_text((ROOT / LINEFORM).read_text().replace("mid([x[pid + 1], x[pid - 1]])", "x[pid + 1] + x[pid - 1]"))
check("a wrong program after a right one", rondo("prove", str(copy)).returncode == 1)

# Every `unsat` comes with a refutation that holds, for its own script and for no other.
certificates = [FOLDER / f"{name}.cert" for name in ("it", "it-2")]
rondo("solve", "--cert", str(certificates[0]), *map(str, SCRIPTS))
for script, path in zip([s for s in SCRIPTS if "unsat" in s.read_text()], certificates):
    done = rondo("certify", "--of", str(script), str(path))
    check(f"certify {script.name}", done.returncode == 0 and "accepted" in done.stdout, done.stdout + done.stderr)
    check("certify of another", rondo("certify", "--of", str(polynomial), str(path)).returncode == 1)
    path.write_text(path.read_text().replace("(check-sat)", "(contradiction)"))
    done = rondo("certify", "--json", str(path))
    check("certify a wrong step", done.returncode == 1 and "certificate-rejected" in done.stdout, done.stdout)
check("certificates are written by one engine", rondo("solve", "--solver", "z3", "--cert", "x", str(polynomial)).returncode == 2)
check("certify nothing", rondo("certify", "missing.cert").returncode == 1)

# Obligations as files that another solver decides alike.
out = FOLDER / "smt"
check("smt-out", rondo("prove", "--no-cache", LINEFORM, "--smt-out", str(out)).returncode == 0)
files = sorted(out.glob("*.smt2"))
check("smt files", len(files) == 8, [f.name for f in files])
for file in files:
    answer = subprocess.run(["cvc5", "--lang=smt2", str(file)], capture_output=True, text=True, timeout=300).stdout
    check(f"cvc5 on {file.name}", answer.strip() == "unsat", answer)
done = rondo("prove", "--no-cache", LINEFORM, "--smt-out", "/proc/nowhere")
check("smt-out into nowhere", done.returncode == 1 and "cannot use the folder" in done.stderr, done.stderr)

# JSON says what the text says.
report = json.loads(rondo("prove", "--json", "examples/koord/mutex_naive.koord").stdout)
check("json", report["status"] == 1 and report["diagnostics"][0]["kind"] == "koord-refuted", report)
check("ast", json.loads(rondo("ast", "--json", LINEFORM).stdout)["program"]["items"][0]["name"] == "Motion")

# A specification beside the program, or elsewhere.
(FOLDER / "p.koord").write_text("local:\n    int n = 0\nStep:\n    eff:\n        n = 1\n")
check("no invariant", "koord-no-invariant" in rondo("prove", str(FOLDER / "p.koord")).stderr)
(FOLDER / "p.spec").write_text("invariant small: forall i in ID: n[i] <= 1 and n[i] >= 0\n")
check("spec beside", rondo("prove", str(FOLDER / "p.koord")).returncode == 0)
(FOLDER / "other.spec").write_text("invariant zero: forall i in ID: n[i] == 0\n")
check("--spec", rondo("prove", str(FOLDER / "p.koord"), "--spec", str(FOLDER / "other.spec")).returncode == 1)
(FOLDER / "p.spec").write_text("invariant small: forall i in ID: m[i] <= 1\n")
wrong = rondo("check", str(FOLDER / "p.koord"))
check("error in the spec", "p.spec:1:" in wrong.stderr and wrong.returncode == 1, wrong.stderr)

# Formatting: in place, checked, never over an error.
ugly = FOLDER / "ugly.koord"
ugly.write_text("local: int n # count\nStep:\n  pre (n=1)\n  eff: n=2 // two\n")
check("fmt --check", rondo("fmt", "--check", str(ugly)).returncode == 1)
check("fmt", rondo("fmt", str(ugly)).returncode == 0)
check("fmt --check after", rondo("fmt", "--check", str(ugly)).returncode == 0, ugly.read_text())
check("comments survive", "# count" in ugly.read_text() and "# two" in ugly.read_text(), ugly.read_text())
ugly.write_text("local: int\n")
check("fmt of an error", rondo("fmt", str(ugly)).returncode == 1 and ugly.read_text() == "local: int\n")
for example in sorted([*(ROOT / "examples/koord").glob("*.koord"), *(ROOT / "examples/koord").glob("*.spec")]):
    done = rondo("fmt", "--check", str(example))
    check(f"{example.name} is formatted", done.returncode == 0, done.stdout + done.stderr)

for shell in ("bash", "zsh", "fish"):
    script = rondo("completion", shell).stdout
    check(f"completion {shell}", "prove" in script and "robots" in script)
check("bash reads it", subprocess.run(["bash", "-n"], input=rondo("completion", "bash").stdout, text=True).returncode == 0)

# A disagreeing solver is reported loudly.
liar = FOLDER / "liar"
liar.write_text("#!/bin/sh\ncat > /dev/null\necho sat\n")
liar.chmod(0o755)
done = rondo("prove", "--no-cache", LINEFORM, "--cross-check", str(liar))
check("disagreement", done.returncode == 4 and "koord-disagreement" in done.stderr and "proved for" not in done.stdout, done.stdout)

# Ctrl-C: a clean end, what was finished is printed, the status says that not all is known.
slow = FOLDER / "slow.koord"
slow.write_text((ROOT / "tests/mutants/delivery_margin.koord").read_text())
process = subprocess.Popen([RONDO, "prove", "--no-cache", str(slow)], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENV)
time.sleep(0.5)  # any moment will do
process.send_signal(signal.SIGINT)
stdout, stderr = process.communicate(timeout=120)
check("Ctrl-C", process.returncode in (1, 3) and "proved for every N: separated" not in stdout, f"{process.returncode} {stdout} {stderr}")

print(f"{results['passed']} passed, {results['failed']} failed")
sys.exit(1 if results["failed"] else 0)
