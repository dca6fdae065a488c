"""Streams to the open pages: scenes in order, frames the newest only, a few under way."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable

__all__ = ["WINDOW", "Connection", "Hub"]

WINDOW = 2
"""Messages that may be under way to a page before it has drawn them."""

_LONGEST_REPLY = 32


class Connection:
    """The stream to one page.

    Parameters
    ----------
    send : callable
        Sends bytes.
    page : str
        By which its page is known.
    """

    def __init__(self, send: Callable[[bytes], Awaitable[None]], page: str = "") -> None:
        self._send = send
        self.page = page
        self._queue: deque[bytes] = deque()
        self._newest: bytes | None = None
        self._wake = asyncio.Event()
        self.under_way = 0
        self.most_under_way = 0
        self.sent = 0
        self.dropped = 0

    def put(self, message: bytes) -> None:
        """Queue a message that must arrive; frames before it are void."""
        self._newest = None
        self._queue.append(message)
        self._wake.set()

    def offer(self, message: bytes) -> None:
        """Offer a frame; it takes the place of one that has not gone yet."""
        self.dropped += self._newest is not None
        self._newest = message
        self._wake.set()

    @property
    def is_ready(self) -> bool:
        """Whether a frame offered now would go at once."""
        return self.under_way < WINDOW and not self._queue and self._newest is None

    def reply(self, text: str) -> bool:
        """Take what the page said; tell whether it made sense."""
        word, _, number = text[:_LONGEST_REPLY].partition(" ")
        if word != "ack" or not (number.isascii() and number.isdigit()) or len(number) > 4:
            return False
        self.under_way = max(self.under_way - int(number), 0)
        self._wake.set()
        return True

    async def run(self) -> None:
        """Send until cancelled."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self.under_way < WINDOW:
                if self._queue:
                    message = self._queue.popleft()
                elif self._newest is not None:
                    message, self._newest = self._newest, None
                else:
                    break
                self.under_way += 1
                self.most_under_way = max(self.most_under_way, self.under_way)
                self.sent += 1
                await self._send(message)


class Hub:
    """All open streams."""

    def __init__(self) -> None:
        self._connections: set[Connection] = set()
        self._changed = asyncio.Event()

    @property
    def connections(self) -> tuple[Connection, ...]:
        """Streams to the open pages."""
        return tuple(self._connections)

    def of(self, page: str) -> Connection | None:
        """Return the stream to a page, or None while it has none."""
        return next((each for each in self._connections if each.page == page), None)

    def add(self, connection: Connection) -> None:
        """Add a page."""
        self._connections.add(connection)
        self._changed.set()

    def remove(self, connection: Connection) -> None:
        """Forget a page."""
        self._connections.discard(connection)
        self._changed.set()

    def put(self, message: bytes) -> None:
        """Send a message to all pages."""
        for connection in self._connections:
            connection.put(message)

    def offer(self, message: bytes) -> None:
        """Offer a frame to all pages."""
        for connection in self._connections:
            connection.offer(message)

    def noticed(self) -> None:
        """Look again whether a page is ready."""
        self._changed.set()

    async def ready(self) -> None:
        """Wait until a page could draw a frame."""
        while not any(connection.is_ready for connection in self._connections):
            self._changed.clear()
            await self._changed.wait()
