"""Scenes that are built in Python: a dict as the text of a scene file, so that it is read, checked and refused by the same rules."""
import math


def to_toml(scene: dict) -> str:
    """A dict as TOML, a key a line: dicts are tables, lists of dicts lists of tables, NumPy arrays and numbers what they hold."""
    if not isinstance(scene, dict):
        raise TypeError(f"a scene is a path, the name of a case, or a dict, not {type(scene).__name__}")
    return "".join(f"{_key(key)} = {value(v)}\n" for key, v in scene.items())


def value(v):
    """One value as TOML text."""
    if hasattr(v, "tolist"):  # of NumPy
        v = v.tolist()
    if isinstance(v, bool):
        return "true" if v else "false"
    if isinstance(v, int):
        return str(v)
    if isinstance(v, float):
        return repr(v) if math.isfinite(v) else ("nan" if v != v else "inf" if v > 0 else "-inf")
    if isinstance(v, str):
        return '"' + "".join(_letter(c) for c in v) + '"'
    if isinstance(v, dict):
        return "{" + ", ".join(f" {_key(key)} = {value(x)}" for key, x in v.items()) + " }"
    if isinstance(v, (list, tuple)):
        return "[" + ", ".join(value(x) for x in v) + "]"
    raise TypeError(f"a scene holds booleans, numbers, strings, lists and dicts, not {type(v).__name__}: {v!r}")


def _key(key):
    if not isinstance(key, str):
        raise TypeError(f"keys of a scene are strings, not {key!r}")
    plain = key and all(c.isascii() and (c.isalnum() or c in "_-") for c in key)
    return key if plain else value(key)


def _letter(c):
    if c in '"\\':
        return "\\" + c
    return c if ord(c) >= 32 and c != "\x7f" else f"\\u{ord(c):04x}"
