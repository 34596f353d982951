#!/usr/bin/env python3
"""Makes C++ of ROS 2 message definitions: for each package a header with its structures and a source with their CDR
encoding, their definition for MCAP (`ros2msg`) and their hash (RIHS01, REP-2011).

  ros_messages.py MSG_DIR OUT_DIR     reads MSG_DIR/PACKAGE/TYPE.msg, writes OUT_DIR/ros/PACKAGE.h and .cc

A definition has one field in each line, `TYPE NAME`, and nothing else: no comments, constants or defaults.
"""
import hashlib
import json
import pathlib
import re
import sys

# Name in definitions: C++ type, number in type descriptions.
PRIMITIVES = {
    "bool": ("bool", 15), "byte": ("uint8_t", 16), "char": ("uint8_t", 3), "int8": ("int8_t", 2), "uint8": ("uint8_t", 3),
    "int16": ("int16_t", 4), "uint16": ("uint16_t", 5), "int32": ("int32_t", 6), "uint32": ("uint32_t", 7),
    "int64": ("int64_t", 8), "uint64": ("uint64_t", 9), "float32": ("float", 10), "float64": ("double", 11),
    "string": ("std::string", 17)}
SIZES = {"bool": 1, "byte": 1, "char": 1, "int8": 1, "uint8": 1, "int16": 2, "uint16": 2, "int32": 4, "uint32": 4,
         "int64": 8, "uint64": 8, "float32": 4, "float64": 8, "string": 4}
SEPARATOR = "=" * 80


class Field:
    """One line of a definition: `base`, with `length` items if it is an array, any number if `sequence`."""

    def __init__(self, package, line, where):
        match = re.fullmatch(r"([\w/]+)(?:<=(\d+))?(\[(\d*)\])? (\w+)", line)
        if not match:
            sys.exit(f"{where}: `{line}` is no field")
        base, bound, brackets, length, self.name = match.groups()
        self.bound = int(bound or 0)
        self.primitive = base in PRIMITIVES
        if self.bound and base != "string":
            sys.exit(f"{where}: only strings are bounded")
        self.base = base if self.primitive or "/" in base else f"{package}/{base}"
        self.length = int(length) if length else 0
        self.sequence = brackets is not None and not length
        self.text = line
        if self.sequence and base == "bool":
            sys.exit(f"{where}: sequences of bool are not supported")

    def cpp(self):
        item = PRIMITIVES[self.base][0] if self.primitive else self.base.replace("/", "::")
        if self.length:
            return f"std::array<{item}, {self.length}>"
        return f"std::vector<{item}>" if self.sequence else item

    def described(self):
        number = PRIMITIVES[self.base][1] if self.primitive else 1
        if self.bound:
            number = 21
        number += 48 if self.length else 144 if self.sequence else 0
        nested = "" if self.primitive else self.base.replace("/", "/msg/")
        return {"name": self.name, "type": {"type_id": number, "capacity": self.length, "string_capacity": self.bound,
                                            "nested_type_name": nested}}


def read(folder):
    """{package/Type: its fields}"""
    messages = {}
    for path in sorted(folder.glob("*/*.msg")):
        package = path.parent.name
        lines = path.read_text(encoding="ascii").splitlines()
        messages[f"{package}/{path.stem}"] = [Field(package, line, path) for line in lines]
    return messages


def nested(messages, name):
    """The types that a type is made of, each once, in the order in which they appear."""
    found = []
    for field in messages[name]:
        if field.primitive:
            continue
        if field.base not in messages:
            sys.exit(f"{name}: there is no message `{field.base}`")
        for inner in [field.base] + nested(messages, field.base):
            if inner not in found:
                found.append(inner)
    return found


def description(messages, name):
    fields = [f.described() for f in messages[name]] or [
        {"name": "structure_needs_at_least_one_member",
         "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]
    return {"type_name": name.replace("/", "/msg/"), "fields": fields}


def type_hash(messages, name):
    whole = {"type_description": description(messages, name),
             "referenced_type_descriptions": [description(messages, n) for n in sorted(nested(messages, name))]}
    return "RIHS01_" + hashlib.sha256(json.dumps(whole).encode("ascii")).hexdigest()


def definition(messages, name):
    def text(n):
        return "".join(f.text + "\n" for f in messages[n])
    return text(name) + "".join(f"{SEPARATOR}\nMSG: {n}\n{text(n)}" for n in nested(messages, name))


def least(messages, name):
    """How many bytes a value has at least."""
    def of(field):
        one = SIZES[field.base] if field.primitive else least(messages, field.base)
        return 4 if field.sequence else one * (field.length or 1)
    return sum(map(of, messages[name])) or 1


def ordered(messages, package):
    """The types of a package, each behind those that it is made of."""
    done = []
    for name in messages:
        if name.split("/")[0] == package:
            for n in list(reversed(nested(messages, name))) + [name]:
                if n.split("/")[0] == package and n not in done:
                    done.append(n)
    return done


def encode(field):
    value = f"m.{field.name}"
    if field.sequence:
        yield f"  w.Count({value}.size());"
    if field.length or field.sequence:
        yield f"  for (const auto& x : {value}) {'w.Value(x)' if field.primitive else 'Encode(w, x)'};"
    else:
        yield f"  {'w.Value' if field.primitive else 'Encode'}({'' if field.primitive else 'w, '}{value});"


def decode(messages, field):
    value = f"m.{field.name}"
    size = SIZES[field.base] if field.primitive else least(messages, field.base)
    if field.sequence:
        yield f"  {value}.resize(r.Count({size}));"
    if field.length or field.sequence:
        yield f"  for (auto& x : {value}) {'r.Value(x)' if field.primitive else 'Decode(r, x)'};"
    elif field.bound:
        yield f"  r.Value({value}, {field.bound});"
    else:
        yield f"  {'r.Value' if field.primitive else 'Decode'}({'' if field.primitive else 'r, '}{value});"


def header(messages, package, types):
    uses = sorted({n.split("/")[0] for t in types for n in nested(messages, t)} - {package})
    out = ["#pragma once", "", "#include <array>", "#include <string>", "#include <vector>", "", '#include "ros/cdr.h"',
           '#include "ros/message.h"'] + [f'#include "ros/{p}.h"' for p in uses]
    out += ["", f"// Made from ros/msg/{package}.", f"namespace rondo::ros::{package} {{", ""]
    for t in types:
        short = t.split("/")[1]
        out.append(f"struct {short} {{")
        for f in messages[t]:
            scalar = f.primitive and f.base != "string" and not f.sequence
            out.append(f"  {f.cpp()} {f.name}{'{}' if scalar or f.length else ''};")
        out += [f"  static const Message kMessage;", "};", f"void Encode(CdrWriter& w, const {short}& m);",
                f"void Decode(CdrReader& r, {short}& m);", ""]
    return "\n".join(out + [f"}}  // namespace rondo::ros::{package}", ""])


def source(messages, package, types):
    out = [f'#include "ros/{package}.h"', "", f"namespace rondo::ros::{package} {{", ""]
    for t in types:
        short = t.split("/")[1]
        lines = definition(messages, t).splitlines()
        text = "\n    ".join(json.dumps(line + "\n") for line in lines) or '""'
        out += [f"const Message {short}::kMessage{{", f'    "{package}/msg/{short}",',
                f'    "{type_hash(messages, t)}",', f"    {text}}};", ""]
        fields = messages[t]
        out.append(f"void Encode(CdrWriter& w, const {short}&{' m' if fields else ''}) {{")
        out += [line for f in fields for line in encode(f)] or ["  w.Value(uint8_t{0});"]
        out += ["}", f"void Decode(CdrReader& r, {short}&{' m' if fields else ''}) {{"]
        out += [line for f in fields for line in decode(messages, f)] or ["  uint8_t nothing = 0;", "  r.Value(nothing);"]
        out += ["}", ""]
    return "\n".join(out + [f"}}  // namespace rondo::ros::{package}", ""])


def main():
    messages = read(pathlib.Path(sys.argv[1]))
    out = pathlib.Path(sys.argv[2]) / "ros"
    out.mkdir(parents=True, exist_ok=True)
    for package in sorted({name.split("/")[0] for name in messages}):
        types = ordered(messages, package)
        for suffix, text in ((".h", header(messages, package, types)), (".cc", source(messages, package, types))):
            path = out / (package + suffix)
            if not path.exists() or path.read_text(encoding="ascii") != text:
                path.write_text(text, encoding="ascii")


if __name__ == "__main__":
    main()
