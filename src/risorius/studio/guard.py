"""Who may talk to the studio, and where it may write.

The studio listens on the loopback interface. A web page from elsewhere that runs in the same
browser could reach it there all the same: by its Origin, or by a name of its own that it lets
point to 127.0.0.1. Both are refused before anything else looks at the request.
"""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from risorius.errors import FormatError, ParameterError

__all__ = ["Guard", "inside", "plain_name", "require_allowed"]

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]

_LOOPBACK = ("127.0.0.1", "localhost", "::1")
_LONGEST_NAME = 80
_PLAIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9 ._-]*")
_DEVICES = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?$", re.IGNORECASE)


class Guard:
    """Middleware that lets only pages of the studio itself in.

    Parameters
    ----------
    app : callable
        The application behind it.
    hosts : iterable of str
        Names under which the studio may be called, beside the loopback ones.
    """

    def __init__(self, app: Any, hosts: Iterable[str] = ()) -> None:
        self._app = app
        self._hosts = frozenset((*_LOOPBACK, *hosts))

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] in ("http", "websocket"):
            headers = {name.lower(): value for name, value in scope.get("headers", ())}
            host = headers.get(b"host", b"").decode("latin-1")
            origin = headers.get(b"origin", b"").decode("latin-1")
            if not self.allows(host, origin):
                await _refuse(scope, send)
                return
        await self._app(scope, receive, send)

    def allows(self, host: str, origin: str) -> bool:
        """Tell whether a request with these headers comes from the studio's own page."""
        called = _split(f"//{host}")
        if called is None or called[0] not in self._hosts:
            return False
        if not origin:
            return True
        came = _split(origin)
        return came is not None and came == called


def _split(address: str) -> tuple[str, int | None] | None:
    try:
        parts = urlsplit(address)
        if not parts.hostname:
            return None
        return parts.hostname, parts.port or {"http": 80, "https": 443}.get(parts.scheme)
    except ValueError:
        return None


async def _refuse(scope: Scope, send: Send) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    body = b"refused: open the studio under the address that it printed"
    headers = [(b"content-type", b"text/plain"), (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def plain_name(name: str, *, endings: Iterable[str] = ()) -> str:
    """Return `name` if it is a plain file name, without a way to anywhere else.

    Raises
    ------
    ParameterError
        If it has separators, is hidden, too long, or of another ending than `endings`.
    """
    sound = _PLAIN.fullmatch(name) is not None and not _DEVICES.fullmatch(name)
    if not sound or len(name) > _LONGEST_NAME or name.endswith((".", " ")):
        raise ParameterError(
            f"file name {name[:40]!r}: use letters, digits, blanks, . _ and - only, at most "
            f"{_LONGEST_NAME}"
        )
    known = tuple(endings)
    if known and not name.lower().endswith(known):
        raise ParameterError(f"file name {name[:40]!r}: must end in {' '.join(known)}")
    return name


def inside(folder: Path, name: str, *, endings: Iterable[str] = ()) -> Path:
    """Return the path of a file of a plain name in `folder`.

    Raises
    ------
    ParameterError
        If `name` is not plain.
    FormatError
        If a link in the folder leads out of it.
    """
    path = folder / plain_name(name, endings=endings)
    if not path.resolve().is_relative_to(folder.resolve()):
        raise FormatError(f"{path}: leads out of the project's folder; remove the link")
    return path


def require_allowed(host: str, *, allow_remote: bool) -> str:
    """Return `host` if the studio may listen there.

    Raises
    ------
    ParameterError
        If it is not a loopback address and nobody said that this is wanted.
    """
    if host not in _LOOPBACK and not allow_remote:
        raise ParameterError(
            f"host: {host!r} would let other machines in, and the studio asks for no password; "
            "leave it out"
        )
    return host
