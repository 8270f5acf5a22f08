"""The live view of a simulation, a page on this machine."""

import html
import weakref
from urllib.parse import urlsplit

from . import scenes
from .errors import UsageError

_open = weakref.WeakSet()  # the simulations' compiled parts with a page


class View:
    """The page that shows a simulation: see ``Simulation.view``. ``address`` is where; whoever knows it may look, and
    pause and stop. In a notebook it is shown as a link, or in place by ``Simulation.widget``. It ends with ``close()``,
    with its simulation, and with the interpreter; ``with sim.view() as view:`` closes it too."""

    __slots__ = ("_core", "_address", "_height")

    def __init__(self, core, address, height):
        self._core = core
        self._address = address
        self._height = height

    @property
    def address(self):
        return self._address

    def close(self):
        """Ends the page, from any thread. A simulation that it has paused goes on."""
        self._core.close_view()
        _open.discard(self._core)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __repr__(self):
        return f"<keeler.View: {self._address}>"

    def _repr_html_(self):
        address = html.escape(self._address, quote=True)
        if self._height is None:
            return f'<a href="{address}" target="_blank" rel="noopener">{address}</a>'
        return f'<iframe src="{address}" width="100%" height="{self._height}" style="border: 0"></iframe>'


def open_view(core, title, port, height):
    """Returns the view of a simulation's compiled part."""
    port = scenes.whole_number(port, "port", 0, 65535)
    if height is not None:
        height = scenes.whole_number(height, "height", 100, 10000)
    address = core.open_view(title, port)
    open_port = urlsplit(address).port
    if port not in (0, open_port):
        raise UsageError(f"the page of this simulation is open at the port {open_port}, not {port}; close() it first, or leave port out")
    view = View(core, address, height)
    _open.add(core)
    return view


def close_all():
    """Ends all pages: their threads must not outlive the interpreter."""
    for core in list(_open):
        core.close_view()
