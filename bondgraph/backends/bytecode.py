"""Templates are compiled once: those of one model take a fifth of the time of `compile`."""

from __future__ import annotations

from hashlib import sha256

import jinja2
from jinja2.bccache import Bucket

from bondgraph.cache import Cache, user_cache


class _Kept(jinja2.BytecodeCache):
    """Compiled templates; Jinja itself looks whether one is of the template as it is now."""

    def __init__(self, cache: Cache, options: str) -> None:
        self.cache = cache
        self.form = f"{jinja2.__version__} {options}"

    def _name(self, bucket: Bucket) -> str:
        # by its text, not its path: another installation has the same template elsewhere
        return sha256(f"{self.form} {bucket.checksum}".encode()).hexdigest()[:32]

    def load_bytecode(self, bucket: Bucket) -> None:
        """The code of a template, if what is kept is of its present text."""
        for path in self.cache.find(self._name(bucket)):
            if bucket.code is None:
                bucket.bytecode_from_string(path.read_bytes())

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep the code of a template."""
        self.cache.keep(self._name(bucket), bucket.bytecode_to_string())


def kept_templates(options: str) -> jinja2.BytecodeCache | None:
    """The templates that this user has compiled with these options of Jinja.

    None where there is no folder that can be trusted with code: they are compiled at each start.
    """
    cache = user_cache("template", lambda why: None)
    return None if cache is None else _Kept(cache, options)
