"""What holds for all tests."""

import signal

# A shell that starts a job in the background has it ignore Ctrl-C, and Python then leaves it so.
signal.signal(signal.SIGINT, signal.default_int_handler)
