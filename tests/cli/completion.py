#!/usr/bin/env python3
"""completion.py KEYS EXPECTED SHELL ARGUMENT...: starts a shell on a terminal, types the keys (with \\t for the tabulator)
and waits until the line reads as expected. Ends with 1 when it does not within ten seconds."""
import fcntl
import os
import pty
import re
import select
import struct
import sys
import termios
import time

keys, expected, command = sys.argv[1].replace("\\t", "\t"), sys.argv[2], sys.argv[3:]
child, terminal = pty.fork()
if child == 0:
    fcntl.ioctl(1, termios.TIOCSWINSZ, struct.pack("HHHH", 40, 150, 0, 0))
    os.execvp(command[0], command)


def shown(drawn):
    """Returns the text as shown on the screen: shells move back and overwrite."""
    text, at = [], 0
    for letter in re.sub(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>]|[\x00\r\x07]", "", drawn.decode(errors="replace")):
        if letter == "\b":
            at -= 1
        else:
            text[at : at + 1] = [letter]
            at += 1
    return "".join(text)


def read(seconds):
    """Whether anything came within this time."""
    global drawn
    if not select.select([terminal], [], [], seconds)[0]:
        return False
    try:
        drawn += os.read(terminal, 65536)
    except OSError:  # the shell has gone
        return False
    return True


def read_until(words, seconds=10):
    """Whether these words come to stand on the screen."""
    end = time.monotonic() + seconds
    while words not in shown(drawn) and (left := end - time.monotonic()) > 0:
        read(left)
    return words in shown(drawn)


drawn = b""
read_until("ready> ")
for part in re.findall(r"\t|[^\t]+", keys):  # a shell that is still completing would take the next keys for text
    os.write(terminal, part.encode())
    read(10)
    while read(0.5):
        pass
stands = read_until(expected)
os.kill(child, 9)
if not stands:
    sys.exit(f"{command[0]}: after {keys!r} no '{expected}' in {shown(drawn)!r}")
