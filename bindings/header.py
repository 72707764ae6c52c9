"""Reads include/pliant.h, which is written so that this suffices: one declaration per statement, no nested types."""
import re

SCALARS = {"int32_t", "uint32_t", "uint64_t", "size_t", "double", "float", "uint8_t", "char", "void", "pliant_status"}


class Header:
    """constants: [(name, value)]; opaque: [name]; structs: [(name, [(type, field)])];
    callbacks: [(name, result, [(type, name)])]; functions: the same."""

    def __init__(self, path):
        text = open(path, encoding="utf-8").read()
        text = re.sub(r"//[^\n]*", "", text)
        self.constants = re.findall(r"#define (PLIANT_(?:ABI_VERSION|NONE)) (\w+)", text)
        text = re.sub(r"^#.*$", "", text, flags=re.M).replace('extern "C" {', "")
        for body in re.findall(r"\benum \{(.*?)\}", text, re.S):
            self.constants += re.findall(r"(PLIANT_\w+) = (\d+)", body)
        self.opaque = re.findall(r"typedef struct (\w+) \1;", text)
        self.structs = [(name, self._fields(body))
                        for name, body in re.findall(r"typedef struct (\w+) \{(.*?)\} \1;", text, re.S)]
        self.callbacks = [(name, result.strip(), self._parameters(args)) for result, name, args in
                          re.findall(r"typedef (\w[\w ]*\*?) ?\(\*(\w+)\)\(([^)]*)\);", text)]
        self.functions = [(name, result.strip(), self._parameters(args)) for result, name, args in
                          re.findall(r"PLIANT_API (\w[\w ]*\*?) ?(pliant_\w+)\(([^)]*)\);", text)]

    @staticmethod
    def _parameters(text):
        text = " ".join(text.split())
        if text in ("", "void"):
            return []
        return [Header._typed(each) for each in text.split(",")]

    @staticmethod
    def _typed(text):
        match = re.fullmatch(r"\s*(.*?[ *])(\w+)\s*", text, re.S)
        return match[1].strip(), match[2]

    @staticmethod
    def _fields(body):
        fields = []
        for line in body.split(";"):
            line = " ".join(line.split())
            pointer = re.match(r"\w+ \(\*(\w+)\)\(", line)
            if pointer:
                fields.append(("function", pointer[1]))
            elif line:
                first, *more = line.split(",")
                kind, name = Header._typed(first)
                fields += [(kind, name)] + [(kind, each.strip()) for each in more]
        return fields
