"""relief-lab: eval, measure and pairs here; bench and the sections that are not Python's in C."""

import importlib
import os
import signal
import sys

from . import sections


HELP = """usage: relief-lab COMMAND ...

Relief's laboratory measures Relief itself: accuracy, time and memory.

  eval       accuracy where the truth is known, against goals and bounds
  measure    missing points and wrong normals: table 5.1 of the thesis
  pairs      which picture looks real? a page that asks
  bench      time and memory of every stage, and how they grow

examples:
  relief-lab eval --scene room --seeds 1     one scene, seconds
  relief-lab eval                            every figure, minutes
  relief-lab bench --source synthetic:room   milliseconds of every stage

relief-lab COMMAND --help tells a command's options.
"""


def run(command, words):
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell has it ignored
    try:
        return importlib.import_module("relief_lab." + command).main(words)
    except sections.Failed as error:
        print(error, file=sys.stderr)
        return leave(error.status)
    except KeyboardInterrupt:
        print("relief-lab %s: stopped; nothing was written" % command, file=sys.stderr)
        return leave(128 + signal.SIGINT)
    except (RuntimeError, OSError, ValueError) as error:
        return refuse(error)


def leave(status):
    """At once: processes that were ended have left nothing to wait for."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def refuse(error):
    """An error of Relief's is one line; any other one is a fault of the laboratory."""
    if not type(error).__module__.startswith("relief"):
        raise error
    print("relief-lab: %s" % error, file=sys.stderr)
    return 1


def main():
    words = sys.argv[1:]
    if words[:1] == ["help"] and len(words) == 2:
        words = [words[1], "--help"]
    if not words or words[0] in ("help", "--help", "-h"):
        print(HELP, end="")
        return 0
    if words[0] in ("eval", "measure", "pairs"):
        return run(words[0], words[1:])
    os.execv(sections.SECTIONS_PROGRAM, [sections.SECTIONS_PROGRAM, *words])
    return 1


if __name__ == "__main__":
    sys.exit(main())
