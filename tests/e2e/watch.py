#!/usr/bin/env python3
"""`rondo watch`: what it does when files change.

  watch.py RONDO
"""
import os
import pathlib
import select
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
results = {"passed": 0, "failed": 0}


def check(name, good, *why):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}:", *(str(w)[-900:] for w in why))


class Watch:
    def __init__(self, folder, *arguments):
        self.process = subprocess.Popen([RONDO, "watch", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=folder)
        self.text = ""

    def wait(self, *words, seconds=60):
        """All that it says until all of the words were said, and forgets that."""
        end = time.monotonic() + seconds
        while not all(w in self.text for w in words):
            if not select.select([self.process.stdout], [], [], max(0, end - time.monotonic()))[0]:
                return None
            more = os.read(self.process.stdout.fileno(), 1 << 16)
            if not more:
                return None
            self.text += more.decode()
        said, self.text = self.text, ""
        return said

    def end(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(timeout=30)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program, spec = folder / "d.koord", folder / "d.spec"
        program.write_text((ROOT / "examples/koord/delivery.koord").read_text())
        spec.write_text((ROOT / "examples/koord/delivery.spec").read_text())
        watch = Watch(folder, "check", "d.koord")
        check("the first run", watch.wait("-- rondo check d.koord", "-- waiting for a change of d.koord, d.spec"), watch.text)
        text = spec.read_text()
        spec.write_text(text.replace("invariant", "invariant nonsense +", 1))
        check("an error in what belongs to it", watch.wait("error", "-- waiting"), watch.text)
        # Editors write another file, and give it the name.
        (folder / "d.spec~").write_text(text)
        (folder / "d.spec~").rename(spec)
        said = watch.wait("-- waiting")
        check("mended", said and "error" not in said, said)
        program.unlink()
        check("the file goes away", watch.wait("-- waiting for a change of d.koord"), watch.text)
        time.sleep(1)
        program.write_text("nonsense\n")
        check("and is there again", watch.wait("-- rondo check", "error", "-- waiting"), watch.text)
        check("ended", watch.end() == 0)

        program.write_text((ROOT / "examples/koord/lineform.koord").read_text())
        spec.unlink()
        watch = Watch(folder, "d.koord", "--no-cache")
        check("without a verb it is proved", watch.wait("-- rondo prove d.koord --no-cache", "-- waiting"), watch.text)
        program.write_text(program.read_text() + "\n# more\n")
        check("and again", watch.wait("-- rondo prove", "-- waiting"), watch.text)
        check("ended again", watch.end() == 0)

        # A run that would take for ever is ended by a change, and by Ctrl-C.
        program.write_text("allread:\n    int x[N_sys] = 0\nStep:\n    pre: true\n    eff:\n        x[pid] = x[pid] + 1\n")
        watch = Watch(folder, "explore", "d.koord", "--robots", "2")
        check("a run without an end", watch.wait("-- rondo explore"), watch.text)
        time.sleep(0.5)
        program.write_text(program.read_text().replace("pre: true", "pre: x[pid] < 2"))
        check("ended by a change", watch.wait("-- rondo explore", "complete", "-- waiting"), watch.text)
        program.write_text(program.read_text().replace("pre: x[pid] < 2", "pre: true"))
        check("again", watch.wait("-- rondo explore"), watch.text)
        began = time.monotonic()
        check("ended by Ctrl-C", watch.end() == 0 and time.monotonic() - began < 20)

        # Nobody listens any more.
        watch = Watch(folder, "check", "d.koord")
        check("somebody listens", watch.wait("-- waiting"), watch.text)
        watch.process.stdout.close()
        for k in range(20):
            program.write_text(f"# {k}\n")
            time.sleep(0.3)
            if watch.process.poll() is not None:
                break
        check("ended when nobody listens", watch.process.poll() is not None)
        watch.process.kill()

        for arguments, wrong in [([], "what should be watched"), (["nonsense"], "is no file"), (["prove", "none.koord"], "nothing in this command is a file")]:
            done = subprocess.run([RONDO, "watch", *arguments], capture_output=True, text=True, cwd=folder)
            check(f"refused: {arguments}", done.returncode == 2 and wrong in done.stderr, done)
    print(f"{results['passed']} passed, {results['failed']} failed")
    return 1 if results["failed"] else 0


if __name__ == "__main__":
    sys.exit(main())
