#!/usr/bin/env python3
"""terminal.py COLUMNS KEELER ARGUMENT...: runs the program on a terminal of this width and prints its output.

Ends with 1, and a message on standard error, if a line of progress is wider than the terminal.
"""
import fcntl
import os
import pty
import re
import struct
import sys
import termios

columns = int(sys.argv[1])
child, terminal = pty.fork()
if child == 0:
    fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    os.execv(sys.argv[2], sys.argv[2:])
drawn = b""
try:
    while block := os.read(terminal, 65536):
        drawn += block
except OSError:  # the other end is closed
    pass
_, status = os.waitpid(child, 0)
text = re.sub(r"\x1b\[[0-9;]*[A-Za-z]", "", drawn.decode())
print(text)
for line in re.split(r"[\r\n]+", text):
    if len(line) > columns and not line.startswith("keeler: "):  # messages are for the terminal to wrap
        print(f"{len(line)} columns on a terminal of {columns}: {line}", file=sys.stderr)
        status = status or 1
sys.exit(1 if status else 0)
