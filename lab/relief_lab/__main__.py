"""relief-lab: eval here; measure, bench and the sections that are not Python's in C."""

import os
import signal
import sys

from . import sections


def run_eval(words):
    from . import eval as accuracy
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell has it ignored
    try:
        return accuracy.main(words)
    except sections.Failed as error:
        print(error, file=sys.stderr)
        return error.status
    except KeyboardInterrupt:
        print("relief-lab eval: stopped; nothing was written", file=sys.stderr)
        return 128 + signal.SIGINT


def main():
    words = sys.argv[1:]
    if words[:1] == ["eval"]:
        return run_eval(words[1:])
    if words[:2] == ["help", "eval"]:
        return run_eval(["--help"])
    os.execv(sections.SECTIONS_PROGRAM, [sections.SECTIONS_PROGRAM, *words])


if __name__ == "__main__":
    sys.exit(main())
