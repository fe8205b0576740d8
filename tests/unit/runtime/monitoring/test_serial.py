"""A monitor on a serial port (a pseudo terminal), whose device vanishes and comes back."""

from __future__ import annotations

import os
import signal
import tty
from collections.abc import Callable
from pathlib import Path

from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import Watch, csv


class Device:
    """The far end of a serial line, under a name that stays when the device is plugged in again."""

    def __init__(self, name: Path) -> None:
        self.name = name
        self.plug()

    def plug(self) -> None:
        self.far, near = os.openpty()
        tty.setraw(near)
        self.name.symlink_to(os.ttyname(near))
        self._near = near  # kept open, so that nothing is lost before the monitor opens it

    def send(self, data: bytes) -> None:
        while data:
            data = data[os.write(self.far, data[:512]) :]

    def unplug(self) -> None:
        self.name.unlink()
        os.close(self._near)
        os.close(self.far)


def test_a_device_is_watched_through_noise_and_unplugging(
    tmp_path: Path, watch: Callable[..., Watch]
) -> None:
    device, log = Device(tmp_path / "port"), motor.log()
    one = watch("--serial", str(device.name), "--baud", "9600")
    one.heard("start")
    # The end of a line, noise, the header as after a reset of the device, rows.
    device.send(b"37,0.1,4.5\n\xf0\x9f\x00\n" + csv(log, 0, 1300, header=True))
    device.send(csv(log, 1300, 2800))
    one.heard("invalid")
    one.heard("warm-up", "from now on")
    device.unplug()
    one.heard("gap", "gone")
    device.plug()
    one.heard("gap", "back")
    # No header this time: the old one holds. The first line after joining may be half of one.
    device.send(b"0.25\n" + csv(log, 2800, 4000))
    device.send(b"end\n" * 10)
    one.heard("fault")
    assert "f" in one.heard("update")["group"]
    one.heard("invalid", "`end`")
    assert one.ended(signal.SIGTERM) == 0
    assert "4000 samples" in one.said[-1]["message"]
    device.unplug()
