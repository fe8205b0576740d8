"""Names of the model as identifiers of a target language."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

_INDEX = re.compile(r"\[(\d+)\]")
_FOREIGN = re.compile(r"[^A-Za-z0-9_]")


#: Files of the C library, modules and words of Python, folders of our own: no file is called so.
_TAKEN = frozenset(
    """
    _ abc aifc and antigravity argparse array as assert ast async asynchat asyncio asyncore atexit
    audioop await base64 bdb binascii bisect break builtins bz2 calendar case cgi cgitb chunk
    class cmath cmd code codecs codeop collections colorsys compileall complex concurrent
    configparser contextlib contextvars continue copy copyreg crypt csv ctype ctypes curses
    dataclasses datetime dbm decimal def del difflib dis distutils doctest elif else email
    encodings ensurepip enum errno exact example except faulthandler fcntl fenv filecmp fileinput
    finally float fnmatch for fractions from ftplib functools gc genericpath getopt getpass
    gettext glob global graphlib grp gzip hashlib heapq hmac html http idlelib if imaplib imghdr
    imp import importlib in inspect inttypes io ipaddress is iso646 itertools json keyword lambda
    lib2to3 limits linecache locale logging lzma mailbox mailcap marshal match math mimetypes mmap
    modulefinder msilib msvcrt multiprocessing netrc nis nntplib nonlocal not nt ntpath nturl2path
    numbers opcode operator optparse or os ossaudiodev pass pathlib pdb pickle pickletools pipes
    pkgutil platform plistlib poplib posix posixpath pprint profile pstats pthread pty pwd
    py_compile pyclbr pydoc pydoc_data pyexpat queue quopri raise random re readline reprlib
    resource return rlcompleter runpy sched secrets select selectors setjmp shelve shlex shutil
    signal site smtpd smtplib sndhdr socket socketserver spwd sqlite3 sre_compile sre_constants
    sre_parse ssl stat statistics stdalign stdarg stdatomic stdbool stdckdint stddef stdint stdio
    stdlib stdnoreturn string stringprep struct subprocess sunau symtable sys sysconfig syslog
    tabnanny tarfile telnetlib tempfile termios tests textwrap tgmath this threading threads time
    timeit tkinter token tokenize tomllib trace traceback tracemalloc try tty turtle turtledemo
    types typing uchar unicodedata unistd unittest urllib uu uuid venv warnings wave wchar wctype
    weakref webbrowser while winreg winsound with wsgiref xdrlib xml xmlrpc yield zipapp zipfile
    zipimport zlib zoneinfo
    """.split()
)


@lru_cache(maxsize=1 << 14)  # each language, and each part of its code, asks for the same names
def identifier(path: str) -> str:
    """A name of the model as an identifier: `.` and `[i]` become `__`, other letters their code.

    Different names of a model stay different, because a name in a model contains no `__`.

    >>> identifier("m[1].wh.ws")
    'm__1__wh__ws'
    >>> identifier("2x"), identifier("θ")
    ('_2x', 'u3b8')
    """
    text = _INDEX.sub(r"__\1", path).replace(".", "__")
    text = _FOREIGN.sub(lambda found: f"u{ord(found.group()):x}", text)
    return f"_{text}" if not text or text[0].isdigit() else text


def spellings(names: Iterable[str], reserved: frozenset[str]) -> dict[str, str]:
    """Each name with the identifier it gets: no reserved word, no identifier twice.

    A name that is free as it is keeps itself; the others get a trailing `_`, in the order given.

    >>> spellings(["int", "int_", "a[1]"], frozenset({"int"}))
    {'int': 'int__', 'int_': 'int_', 'a[1]': 'a__1'}
    """
    wanted = {name: identifier(name) for name in names}
    found: dict[str, str] = {}
    taken: set[str] = set()
    for name, own in wanted.items():
        if own not in reserved and own not in taken:
            found[name] = own
            taken.add(own)
    for name, own in wanted.items():
        if name not in found:
            while own in reserved or own in taken:
                own += "_"
            found[name] = own
            taken.add(own)
    return {name: found[name] for name in wanted}


def snake(name: str) -> str:
    """The name of a model as the stem of files and functions.

    >>> snake("Khepera"), snake("TwoTanks"), snake("RC"), snake("2-mass")
    ('khepera', 'two_tanks', 'rc', '_2_mass')
    """
    text = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()
    text = re.sub(r"[^a-z0-9]+", "_", text).strip("_") or "model"
    return f"_{text}" if text[0].isdigit() else text


def file_name(stem: str) -> str:
    """The name of a model's files: its stem, unless a library has a file of that name.

    >>> file_name("khepera"), file_name("math"), file_name("else")
    ('khepera', 'math_residuals', 'else_residuals')
    """
    return f"{stem}_residuals" if stem in _TAKEN else stem
