"""The server of the studio."""

from __future__ import annotations

import asyncio
import socket
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from nicegui import app, ui
from starlette.websockets import WebSocket, WebSocketDisconnect

from risorius.errors import ParameterError, RisoriusWarning
from risorius.project import Project
from risorius.studio.bakery import Bakery
from risorius.studio.document import Document
from risorius.studio.guard import Guard, require_allowed
from risorius.studio.hub import Connection
from risorius.studio.page import Page
from risorius.studio.viewport import STREAM
from risorius.studio.workshop import Workshop

__all__ = ["Address", "free_port", "serve"]

_FIRST_PORT, _PORTS = 8420, 40


@dataclass(frozen=True)
class Address:
    """Where the studio listens.

    Parameters
    ----------
    host : str
    port : int
    """

    host: str
    port: int

    @property
    def link(self) -> str:
        """What a person types into a browser."""
        return f"http://{self.host}:{self.port}/"


def free_port(host: str, wanted: int | None = None) -> Address:
    """Return an address where nobody listens yet.

    Parameters
    ----------
    host : str
    wanted : int, optional
        The only port that will do; the first free one from 8420 on if left out.

    Raises
    ------
    ParameterError
        If it is taken.
    """
    ports = range(_FIRST_PORT, _FIRST_PORT + _PORTS) if wanted is None else (wanted,)
    for port in ports:
        with socket.socket() as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                trial.bind((host, port))
            except (OSError, OverflowError):
                continue
            return Address(host, port)
    raise ParameterError(f"port: {ports[0]} is taken; give another with --port")


def serve(
    path: Path,
    project: Project | None = None,
    *,
    address: Address,
    browser: bool = True,
    ready: Callable[[Address], None] | None = None,
) -> None:
    """Open a project and serve its studio until interrupted.

    Parameters
    ----------
    path : Path
        The project file; need not exist yet.
    project : Project, optional
        What a new one starts from.
    address : Address
    browser : bool
        Open a browser window.
    ready : callable, optional
        Called once the server listens.

    Raises
    ------
    RisoriusError
        If the project is refused.
    """
    require_allowed(address.host, allow_remote=False)
    document = Document.open(path, project)
    shop = Workshop(document)
    bakery = Bakery(shop)

    def page() -> None:
        Page(shop, bakery)

    def begin() -> None:
        shop.start()
        _tell_warnings(shop)
        if ready is not None:
            ready(address)

    app.on_startup(begin)
    app.on_shutdown(shop.stop)
    app.add_middleware(Guard)
    app.websocket(STREAM)(_stream_of(shop))
    ui.run(
        page,
        host=address.host,
        port=address.port,
        title="risorius studio",
        dark=True,
        reload=False,
        show=browser,
        show_welcome_message=False,
        uvicorn_logging_level="error",
        reconnect_timeout=20.0,
        favicon="🙂",
        ws_max_size=1 << 20,
    )


def _tell_warnings(shop: Workshop) -> None:
    """Show on the pages what the library warns of, beside where it is shown anyway."""
    loop, otherwise = asyncio.get_running_loop(), warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
        if issubclass(category, RisoriusWarning):
            loop.call_soon_threadsafe(shop.complain, str(message))
        otherwise(message, category, *place, **more)

    warnings.showwarning = show


def _stream_of(shop: Workshop) -> Callable[[WebSocket], object]:
    async def stream(websocket: WebSocket) -> None:
        await websocket.accept()
        connection = Connection(websocket.send_bytes, websocket.query_params.get("page", ""))
        shop.hub.add(connection)
        shop.greet(connection.put)
        shop.tell("stream")
        sender = asyncio.create_task(connection.run())
        try:
            while connection.reply(await websocket.receive_text()):
                shop.hub.noticed()
            await websocket.close(1003)
        except (WebSocketDisconnect, KeyError, RuntimeError):
            pass  # the page has gone, or said something that is no text
        finally:
            sender.cancel()
            shop.hub.remove(connection)

    return stream
