#!/usr/bin/env python3
"""`rondo lsp`, as editors speak with it.

  editor.py RONDO
"""
import json
import os
import pathlib
import random
import re
import select
import shutil
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
        print(f"{name}:", *(str(w)[:900] for w in why))


class Editor:
    def __init__(self, *arguments, encodings=None):
        self.process = subprocess.Popen([RONDO, "lsp", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.bytes, self.number, self.heard, self.answers = b"", 0, [], {}
        general = {} if encodings is None else {"general": {"positionEncodings": encodings}}
        self.capabilities = self.ask("initialize", {"processId": None, "rootUri": None, "capabilities": general})["capabilities"]
        self.tell("initialized", {})

    def send(self, message):
        data = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.raw(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))

    def raw(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def ask(self, method, params):
        self.number += 1
        self.send({"id": self.number, "method": method, "params": params})
        answer = self.wait(lambda: self.answers.get(json.dumps(self.number)))
        return None if answer is None else answer.get("result", answer.get("error"))

    def wait(self, found, seconds=60):
        end = time.monotonic() + seconds
        while not found():
            left = end - time.monotonic()
            if left <= 0 or not select.select([self.process.stdout], [], [], left)[0]:
                return None
            more = os.read(self.process.stdout.fileno(), 1 << 16)
            if not more:
                return None
            self.bytes += more
            while b"\r\n\r\n" in self.bytes:
                head, rest = self.bytes.split(b"\r\n\r\n", 1)
                size = int(head.split(b":")[1])
                if len(rest) < size:
                    break
                message, self.bytes = json.loads(rest[:size]), rest[size:]
                if "id" in message and "method" not in message:
                    self.answers[json.dumps(message["id"])] = message
                else:
                    self.heard.append(message)
        return found()

    def last(self, method, uri):
        return next((m["params"] for m in reversed(self.heard) if m["method"] == method and m["params"]["uri"] == uri), None)

    def diagnostics(self, uri, version):
        """What is published about this version of a file."""
        wanted = lambda: (p := self.last("textDocument/publishDiagnostics", uri)) is not None and p.get("version") == version and p
        return (self.wait(wanted) or {"diagnostics": ["none came"]})["diagnostics"]

    def open(self, path, text, version=1):
        self.tell("textDocument/didOpen", {"textDocument": {"uri": path.as_uri(), "languageId": "koord", "version": version, "text": text}})

    def change(self, path, version, *changes):
        self.tell("textDocument/didChange", {"textDocument": {"uri": path.as_uri(), "version": version}, "contentChanges": list(changes)})

    def save(self, path):
        self.tell("textDocument/didSave", {"textDocument": {"uri": path.as_uri()}})

    def close(self):
        self.ask("shutdown", None)
        self.tell("exit", None)
        return self.process.wait(timeout=20)


def place(text, what, after=0):
    """Where a text stands, in UTF-16 units."""
    at = text.index(what, after)
    line = text.count("\n", 0, at)
    begin = text.rfind("\n", 0, at) + 1
    units = lambda t: len(t.encode("utf-16-le")) // 2
    return {"start": {"line": line, "character": units(text[begin:at])}, "end": {"line": line, "character": units(text[begin:at + len(what)])}}


LINEFORM = (ROOT / "examples/koord/lineform.koord").read_text()


def typing(folder):
    path = folder / "a b.koord"
    path.write_text(LINEFORM)
    editor = Editor()
    check("what it can", editor.capabilities["positionEncoding"] == "utf-16" and editor.capabilities["hoverProvider"] is True, editor.capabilities)
    editor.open(path, LINEFORM)
    check("nothing is wrong", all(d["severity"] > 1 for d in editor.diagnostics(path.as_uri(), 1)))
    # A typo, behind what UTF-16 counts twice: an edit within a line.
    word = place(LINEFORM, "target = mid")
    editor.change(path, 2, {"range": word, "text": "targte = mid"})
    found = editor.diagnostics(path.as_uri(), 2)
    wrong = [d for d in found if d["severity"] == 1]
    check("a typo", len(wrong) == 1 and wrong[0]["range"]["start"]["line"] == word["start"]["line"] and "targte" in wrong[0]["message"] and wrong[0]["source"] == "rondo", found)
    text = LINEFORM.replace("target = mid", "targte = mid")
    hover = editor.ask("textDocument/hover", {"textDocument": {"uri": path.as_uri()}, "position": wrong[0]["range"]["start"]})
    check("hover explains", hover and wrong[0]["code"] in hover["contents"]["value"], hover)
    actions = editor.ask("textDocument/codeAction", {"textDocument": {"uri": path.as_uri()}, "range": wrong[0]["range"], "context": {"diagnostics": []}})
    edits = [a for a in actions or [] if a["kind"] == "quickfix"]
    check("a fix is offered", len(edits) == 1 and edits[0]["edit"]["changes"][path.as_uri()][0]["newText"] == "target", actions)
    if edits:
        edit = edits[0]["edit"]["changes"][path.as_uri()][0]
        editor.change(path, 3, {"range": edit["range"], "text": edit["newText"]})
        check("the fix mends it", all(d["severity"] > 1 for d in editor.diagnostics(path.as_uri(), 3)))
    editor.change(path, 4, {"text": "# \U0001f916 " + LINEFORM.replace("using Motion", "using  Motion", 1)})
    edits = editor.ask("textDocument/formatting", {"textDocument": {"uri": path.as_uri()}, "options": {}})
    check("formatted", isinstance(edits, list) and len(edits) <= 1, edits)
    symbols = editor.ask("textDocument/documentSymbol", {"textDocument": {"uri": path.as_uri()}})
    names = {s["name"] for s in symbols}
    check("symbols", {"TargetUpdate", "geofence", "Motion", "x"} <= names, names)
    at = place(LINEFORM, "x[pid] = Motion")["start"]
    editor.change(path, 5, {"text": LINEFORM})
    found = editor.ask("textDocument/definition", {"textDocument": {"uri": path.as_uri()}, "position": at})
    check("where a name is defined", [d["uri"] for d in found] == [path.as_uri()] and found[0]["range"]["start"]["line"] < at["line"], found)
    words = {i["label"] for i in editor.ask("textDocument/completion", {"textDocument": {"uri": path.as_uri()}, "position": at})}
    check("words", {"TargetUpdate", "Motion", "invariant"} <= words, words)
    renaming(editor, path)
    check("no such method", editor.ask("textDocument/nonsense", {}).get("code") == -32601)
    check("parameters that are none", editor.ask("textDocument/hover", {"textDocument": 3}).get("code") == -32602)
    check("a file that nobody opened", editor.ask("textDocument/hover", {"textDocument": {"uri": "file:///none.koord"}, "position": {"line": 0, "character": 0}}) is None)
    editor.tell("textDocument/didClose", {"textDocument": {"uri": path.as_uri()}})
    check("closed: nothing is said any more", editor.wait(lambda: (p := editor.last("textDocument/publishDiagnostics", path.as_uri())) and p["diagnostics"] == [] and "version" not in p), editor.heard[-1:])
    check("goodbye", editor.close() == 0)


def changed(text, edits):
    """A text of ASCII with the edits of a rename."""
    lines = text.splitlines(keepends=True)
    start = lambda p: sum(map(len, lines[:p["line"]])) + p["character"]
    for edit in sorted(edits, key=lambda e: -start(e["range"]["start"])):
        text = text[:start(edit["range"]["start"])] + edit["newText"] + text[start(edit["range"]["end"]):]
    return text


def renaming(editor, path):
    """References and renaming in LineForm, which is open."""
    here = {"textDocument": {"uri": path.as_uri()}, "position": place(LINEFORM, "x[pid] = Motion")["start"]}
    count = len(re.findall(r"\bx\b", re.sub("#.*", "", LINEFORM)))
    found = editor.ask("textDocument/references", {**here, "context": {"includeDeclaration": True}})
    check("references", len(found) == count and all(f["uri"] == path.as_uri() for f in found), len(found), count)
    fewer = editor.ask("textDocument/references", {**here, "context": {"includeDeclaration": False}})
    check("references but the declaration", len(fewer) == count - 1, len(fewer))
    check("highlights", len(editor.ask("textDocument/documentHighlight", here)) == count)
    span = editor.ask("textDocument/prepareRename", here)
    check("what would be renamed", span["end"]["character"] - span["start"]["character"] == 1, span)
    edit = editor.ask("textDocument/rename", {**here, "newName": "spot"})
    text = changed(LINEFORM, edit["changes"][path.as_uri()])
    check("renamed", len(re.findall(r"\bspot\b", text)) == count and re.sub(r"\bspot\b", "x", text) == LINEFORM, edit)
    for name, wrong in [("target", "something else"), ("1x", "no name"), ("", "no name"), ("a b", "no name")]:
        refused = editor.ask("textDocument/rename", {**here, "newName": name})
        check(f"not to `{name}`", wrong in refused.get("message", ""), refused)
    word = {**here, "position": place(LINEFORM, "eff:")["start"]}
    refused = editor.ask("textDocument/rename", {**word, "newName": "effect"})
    check("a word of the language", "nothing that is declared" in refused.get("message", ""), refused)
    refused = editor.ask("textDocument/rename", {**here, "newName": "if"})
    check("to a word of the language", "message" in refused, refused)


def files(folder):
    """What belongs together: a specification, imports; texts of the editor count, not those on the disk."""
    program, spec = folder / "d.koord", folder / "d.spec"
    text, promise = (ROOT / "examples/koord/delivery.koord").read_text(), (ROOT / "examples/koord/delivery.spec").read_text()
    program.write_text(text)
    spec.write_text(promise)
    editor = Editor(encodings=["utf-8", "utf-16"])
    check("utf-8", editor.capabilities["positionEncoding"] == "utf-8")
    editor.open(program, text)
    editor.diagnostics(program.as_uri(), 1)
    broken = promise.replace("invariant", "invariant nonsense +", 1)
    editor.open(spec, broken)
    found = editor.diagnostics(spec.as_uri(), 1)
    check("an error in the specification", any(d["severity"] == 1 for d in found), found)
    editor.change(spec, 2, {"text": promise})
    found = editor.ask("textDocument/definition", {"textDocument": {"uri": spec.as_uri()}, "position": place(promise, "shared_paths")["start"]})
    check("defined in the program", [d["uri"] for d in found] == [program.as_uri()], found)
    edit = editor.ask("textDocument/rename", {"textDocument": {"uri": spec.as_uri()}, "position": place(promise, "shared_paths")["start"], "newName": "routes"})
    check("renamed in both files", set(edit.get("changes", {})) == {program.as_uri(), spec.as_uri()}, edit)
    items = editor.ask("textDocument/completion", {"textDocument": {"uri": spec.as_uri()}, "position": {"line": 0, "character": 0}})
    check("names of the program complete the specification", {"label": "shared_paths", "kind": 6} in items, items[:5])
    check("mended", all(d["severity"] > 1 for d in editor.diagnostics(spec.as_uri(), 2)))
    motion, model = folder / "w.rondo", folder / "m.rondo"
    model.write_text("robot R { state x: length in [0 m, 1 m]  motion Idle() interruptible [0, inf) {} }\n")
    world = 'import "m.rondo"\nworld W { a: R at (0, 0, 0) }\n'
    editor.open(motion, world)
    check("an import", all(d["severity"] > 1 for d in editor.diagnostics(motion.as_uri(), 1)), editor.heard[-1:])
    editor.change(motion, 2, {"text": world.replace("a: R", "a: Q")})
    found = editor.diagnostics(motion.as_uri(), 2)
    check("a robot that is none", any("Q" in d["message"] for d in found), found)
    # What is built in, and units, are nobody's to rename; who imports a file is renamed with it.
    text_of = "def fun f(float a) -> float:\n    return abs(a)\nlocal:\n    float c = 0.0\nEv:\n    eff:\n        c = f(c)\n"
    other = folder / "b.koord"
    editor.open(other, text_of)
    for word, name in [("abs", "sign"), ("float", "real")]:
        refused = editor.ask("textDocument/rename", {"textDocument": {"uri": other.as_uri()}, "position": place(text_of, word)["start"], "newName": name})
        check(f"`{word}` is built in", "nothing that is declared" in refused.get("message", ""), refused)
    editor.change(motion, 3, {"text": world})
    editor.diagnostics(motion.as_uri(), 3)
    model_text = model.read_text()
    editor.open(model, model_text)
    refused = editor.ask("textDocument/rename", {"textDocument": {"uri": model.as_uri()}, "position": place(model_text, "m]")["start"], "newName": "cm"})
    check("a unit", "message" in refused, refused)
    edit = editor.ask("textDocument/rename", {"textDocument": {"uri": model.as_uri()}, "position": place(model_text, "R {")["start"], "newName": "SS"})
    check("who imports it is renamed, too", set(edit.get("changes", {})) == {model.as_uri(), motion.as_uri()}, edit)
    editor.tell("textDocument/didClose", {"textDocument": {"uri": model.as_uri()}})
    # An import that changes changes what depends on it.
    editor.change(motion, 4, {"text": world})
    editor.diagnostics(motion.as_uri(), 4)
    count = len(editor.heard)
    editor.open(model, model.read_text().replace("robot R", "robot S"))
    again = editor.wait(lambda: [d for m in editor.heard[count:] if m["method"] == "textDocument/publishDiagnostics" and m["params"]["uri"] == motion.as_uri() for d in m["params"]["diagnostics"] if "R" in d["message"]], 10)
    check("an import that changes", again, editor.heard[count:])
    # The disk has another text than the editor: what would be proved is not what is shown.
    editor.change(program, 2, {"text": text + "\n# not saved\n"})
    editor.save(spec)
    check("nothing is proved of another text", editor.wait(lambda: any(m["method"] == "rondo/verification" and m["params"]["items"] for m in editor.heard[count:]), 3) is not True)
    editor.tell("textDocument/didClose", {"textDocument": {"uri": program.as_uri()}})
    found = editor.ask("textDocument/definition", {"textDocument": {"uri": spec.as_uri()}, "position": place(promise, "shared_paths")["start"]})
    check("defined in a program that was closed", [d["uri"] for d in found] == [program.as_uri()], found)
    check("goodbye again", editor.close() == 0)


def proofs(folder):
    path = folder / "p.koord"
    faulty = (ROOT / "tests/mutants/lineform_index.koord")
    text = faulty.read_text() if faulty.exists() else LINEFORM
    path.write_text(LINEFORM)
    editor = Editor()
    editor.open(path, LINEFORM)
    editor.diagnostics(path.as_uri(), 1)
    editor.save(path)
    proved = editor.wait(lambda: (v := editor.last("rondo/verification", path.as_uri())) and v["items"] and v)
    check("a proof", proved and proved["version"] == 1 and {i["state"] for i in proved["items"]} == {"proved"}, proved)
    if proved:
        item = proved["items"][0]
        hover = editor.ask("textDocument/hover", {"textDocument": {"uri": path.as_uri()}, "position": item["range"]["start"]})
        check("hover says it", hover and "proved" in hover["contents"]["value"], hover)
    # An edit takes it back at once; what is proved of the text before is never told of this one.
    count = len(editor.heard)
    editor.change(path, 2, {"text": text})
    check("an edit takes it back", editor.wait(lambda: any(m["method"] == "rondo/verification" and m["params"]["items"] == [] and m["params"]["version"] == 2 for m in editor.heard[count:])))
    path.write_text(text)
    editor.save(path)
    wrong = editor.wait(lambda: [d for d in (editor.last("textDocument/publishDiagnostics", path.as_uri()) or {"diagnostics": []})["diagnostics"] if d["source"] == "rondo prove"])
    check("a proof that fails", wrong and any(d["severity"] == 1 for d in wrong) and text != LINEFORM, wrong)
    # A flood: what is said in the end is about the last text, and no older verdict comes behind a newer text.
    editor.save(path)
    generator = random.Random(1)
    for version in range(3, 1003):
        line = generator.randrange(5)
        editor.change(path, version, {"range": {"start": {"line": line, "character": 0}, "end": {"line": line, "character": 0}}, "text": generator.choice(["#", " ", "\n", "x"])})
    editor.diagnostics(path.as_uri(), 1002)
    late = [m["params"] for m in editor.heard if m["method"] == "rondo/verification" and m["params"]["items"] and m["params"]["version"] == 2]
    after = next((i for i, m in enumerate(editor.heard) if m["params"].get("version", 0) > 2), len(editor.heard))
    check("no older verdict behind a newer text", all(not (m["method"] == "rondo/verification" and m["params"]["items"]) for m in editor.heard[after:]), late)
    check("goodbye, in the middle of everything", editor.close() == 0)
    left = subprocess.run(["pgrep", "-f", f"prove {path}"], capture_output=True, text=True).stdout.split()
    check("no proof is left", not left, left)


def hostile():
    for what, data in (("no header", b"hello\r\n\r\n"), ("no number", b"Content-Length: x\r\n\r\n{}"), ("too long", b"Content-Length: 99999999999\r\n\r\n"), ("minus", b"Content-Length: -1\r\n\r\n"),
                       ("a header without an end", b"x" * 10000)):
        process = subprocess.Popen([RONDO, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        out, err = process.communicate(data, timeout=30)
        check(f"hostile: {what}", process.returncode == 1 and out == b"", process.returncode, out, err)
    generator = random.Random(2)
    editor = Editor("--no-proofs")
    bodies = [b"", b"{", b"[]", b"3", b"null", b'{"id": 1}', b'{"method": 3}', b'{"id": {}, "method": "initialize"}', b'{"jsonrpc": "2.0", "id": 5, "method": "textDocument/hover"}', b"\xff\xfe",
              b'{"method": "textDocument/didOpen", "params": {"textDocument": {"uri": "file:///x.koord"}}}', b'{"method": "textDocument/didChange", "params": []}', b"[" * 5000]
    for _ in range(400):
        body = generator.choice(bodies)
        editor.raw(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
    path = pathlib.Path("/nowhere/x.koord")
    editor.open(path, "\x00\xff" + LINEFORM)
    for version in range(2, 300):
        at = {"line": generator.randrange(200), "character": generator.randrange(200)}
        to = {"line": generator.randrange(200), "character": generator.randrange(200)}
        editor.change(path, version, {"range": {"start": at, "end": to}, "text": generator.choice(["", "(", "\U0001f916", "invariant", "\r\n", "]]]"])})
    editor.diagnostics(path.as_uri(), 299)
    check("still alive", editor.close() == 0)
    process = subprocess.Popen([RONDO, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    process.stdin.close()
    check("the editor went away", process.wait(timeout=20) == 1)
    process.send_signal(signal.SIGTERM) if process.poll() is None else None


NEOVIM = """
local verified
vim.lsp.handlers["rondo/verification"] = function(_, result) if #result.items > 0 then verified = result end end
vim.cmd("edit wrong.koord")
vim.wait(30000, function() return #vim.diagnostic.get(0) > 0 end)
for _, d in ipairs(vim.diagnostic.get(0)) do print("found", d.lnum, d.code) end
vim.cmd("edit good.koord")
vim.wait(10000, function() return #vim.lsp.buf_get_clients(0) > 0 end)
vim.cmd("write")
vim.wait(60000, function() return verified ~= nil end)
print("verified", verified and verified.items[1].id or "nothing", verified and verified.items[1].state or "")
vim.cmd("qall!")
"""


def neovim(folder):
    """As docs/editors.md sets it up."""
    if shutil.which("nvim") is None:
        print("skipped: neovim (./dev setup)")
        return
    page = (ROOT / "docs/editors.md").read_text()
    (folder / "init.lua").write_text(page.split("```lua\n", 1)[1].split("```", 1)[0] + NEOVIM)
    (folder / "good.koord").write_text(LINEFORM)
    (folder / "wrong.koord").write_text(LINEFORM.replace("target = mid", "targte = mid"))
    (folder / "bin").mkdir()
    (folder / "bin/rondo").symlink_to(RONDO)
    env = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "HOME": str(folder)}
    done = subprocess.run(["nvim", "--headless", "-u", "NONE", "-c", "luafile init.lua"], capture_output=True, text=True, timeout=200, cwd=folder, env=env)
    said = done.stdout + done.stderr
    check("neovim shows an error", "koord-unknown-member" in said, said)
    check("neovim is told of a proof", "geofence proved" in said.replace("\t", " "), said)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        typing(folder)
        files(folder)
        proofs(folder)
        neovim(folder)
    hostile()
    print(f"{results['passed']} passed, {results['failed']} failed")
    return 1 if results["failed"] else 0


sys.exit(main())
