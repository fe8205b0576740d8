"""Samples from a serial port, which may vanish and come back."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Event, Thread
from typing import TYPE_CHECKING, Any

from bondgraph.runtime.log import LogError
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import IDLE, Chunk, Cutter, Intake, decoded

if TYPE_CHECKING:
    from serial import Serial

_LONGEST = 5.0  # s between two attempts to open the port


class SerialPort:
    """Lines from a serial port; while the device is away it is looked for again and again."""

    replays = False

    def __init__(self, port: str, baud: int, form: Form) -> None:
        self.name = f"{port} at {baud} baud"
        self.decoder: Decoder | None = Decoder(form)
        self._lines = self.decoder
        self._port, self._baud = port, baud
        self._intake = Intake()
        self._over = Event()
        self._serial: Serial | None = self._open()

    def chunks(self, stop: Event) -> Iterator[Chunk]:
        """All lines, until `stop` is set."""
        thread = Thread(target=self._read, daemon=True)
        thread.start()
        try:
            yield from decoded(self._intake, self._lines, stop)
        finally:
            self._over.set()
            thread.join(1.0)

    def go(self, position: dict[str, Any]) -> str:
        """A serial port cannot go back."""
        return "what came through a serial port is gone"

    def rate(self) -> float | None:
        """Not known before samples come."""
        return None

    def close(self) -> None:
        """Close the port."""
        self._over.set()
        if self._serial is not None:
            self._serial.close()

    def _open(self) -> Serial:
        try:
            import serial
        except ImportError as error:
            remedy = "install it (pip install 'bondgraph-arr[robot]')"
            raise LogError(self._port, None, "a serial port needs pyserial", remedy) from error
        try:
            return serial.serial_for_url(self._port, self._baud, timeout=IDLE)
        except (serial.SerialException, ValueError) as error:
            text = str(error.strerror or error) if isinstance(error, OSError) else str(error)
            raise LogError(self._port, None, f"cannot be opened: {text}") from error

    def _read(self) -> None:
        cutter = Cutter(whole=False)
        while not self._over.is_set():
            try:
                if self._serial is None:
                    self._again()
                    cutter = Cutter(whole=False)
                    continue
                piece = self._serial.read(max(1, self._serial.in_waiting))
            except Exception as error:  # drivers raise what they like: the device is gone
                if not self._over.is_set():
                    self._lost(error)
                continue
            block = cutter.cut(piece) if piece else None
            if block is not None:
                self._intake.put(block)

    def _lost(self, error: Exception) -> None:
        self._intake.say("gap", f"{self._port} is gone ({error}); it is looked for again")
        if self._serial is not None:
            self._serial.close()
        self._serial = None

    def _again(self) -> None:
        """Look for the device until it is back, more and more seldom."""
        wait = 0.1
        while not self._over.wait(wait):
            try:
                self._serial = self._open()
            except LogError:
                wait = min(2 * wait, _LONGEST)
            else:
                self._intake.say("gap", f"{self._port} is back")
                return
