"""Ctrl-C raises `KeyboardInterrupt`, also where it is ignored from the start, as in the background of a script."""

import signal

signal.signal(signal.SIGINT, signal.default_int_handler)
