# What a program says at a terminal. SPDX-License-Identifier: MIT
import os
import pty
import re
import select
import signal
import time


def terminal_output(start, seconds, wanted):
    """What comes until `wanted` does, or for so many seconds; then the process is interrupted. start(stderr) starts it."""
    master, slave = pty.openpty()
    process = start(slave)
    text, end = b"", time.monotonic() + seconds
    while time.monotonic() < end and not re.search(wanted, text):
        if select.select([master], [], [], 0.1)[0]:
            text += os.read(master, 4096)
    process.send_signal(signal.SIGINT)
    process.wait(timeout=60)
    os.close(slave)
    os.close(master)
    return text
