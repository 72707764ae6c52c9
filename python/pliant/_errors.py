"""The exceptions of pliant."""
from __future__ import annotations


class Error(Exception):
    """Something that could not be done, as one sentence: what is wrong, where, and what to do.

    A program goes by ``code`` (docs/codes.md), never by the words; ``where``, ``what`` and ``cure`` are the parts of the
    sentence, ``pointer`` is a JSON pointer into a level file.
    """

    def __init__(self, sentence: str = "", *, code: str = "", where: str = "", what: str = "", cure: str = "",
                 pointer: str = "") -> None:
        super().__init__(sentence)
        self.code = code
        self.where = where
        self.what = what or sentence
        self.cure = cure
        self.pointer = pointer

    def __str__(self) -> str:  # KeyError's would be a quotation
        return str(self.args[0]) if self.args else ""

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (type(self), self.args[0] if self.args else "", self.__dict__.copy())


class ArgumentError(Error, ValueError):
    """An argument of the wrong type, shape or range."""


class UnknownName(Error, KeyError, AttributeError):
    """A name that is not there; the sentence has those that are."""


def _rebuild(kind: type[Error], sentence: str, parts: dict[str, str]) -> Error:
    error = kind(sentence)
    error.__dict__.update(parts)
    return error


def argument(where: str, what: str, cure: str = "") -> ArgumentError:
    sentence = f"{where}: {what}" + (f"; {cure}" if cure else "")
    return ArgumentError(sentence, code="arguments", where=where, what=what, cure=cure)


def unknown(word: str, what: str, names: list[str]) -> UnknownName:
    import difflib

    near = difflib.get_close_matches(word, names, 1)
    cure = (f"did you mean '{near[0]}'? " if near else "") + (f"there are: {', '.join(names)}" if names else "there are none")
    return UnknownName(f"unknown {what} '{word}'; {cure}", code="name.unknown", where=what, what=f"unknown {what} '{word}'", cure=cure)
