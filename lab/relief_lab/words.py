"""The command line: options of the subcommands, told in one line when they are wrong."""

import argparse
import os
import sys

from .sections import Failed


def usage(command, text):
    print("relief-lab %s: %s (see `relief-lab %s --help`)" % (command, text, command), file=sys.stderr)
    sys.exit(2)


class Parser(argparse.ArgumentParser):
    """Whole names only; --help prints the text that it was given."""

    def __init__(self, command, text):
        super().__init__(prog=command, add_help=False, allow_abbrev=False)
        self.text = text
        self.add_argument("--help", "-h", action="store_true")

    def error(self, message):
        usage(self.prog, message.replace("argument ", "", 1).replace(": expected one argument", " needs a value"))

    def parse(self, words):
        if "--help" in words or "-h" in words:
            print(self.text, end="")
            sys.exit(0)
        return self.parse_args(words)


def number_within(low, high):
    def take(text):
        value = int(text) if text.lstrip("-").isdigit() else None
        if value is None or not low <= value <= high:
            raise argparse.ArgumentTypeError("'%s': use a number from %d to %d" % (text, low, high))
        return value
    return take


def file_name(ending):
    def take(text):
        if not text.endswith(ending):
            raise argparse.ArgumentTypeError("'%s': give a file that ends in %s" % (text, ending))
        return text
    return take


def check_file(command, path):
    """Before the work: Failed when the file could not be written."""
    if path and not os.access(os.path.dirname(path) or ".", os.W_OK):
        raise Failed("relief-lab %s: %s: cannot be written; check the folder" % (command, path))


def write_file(command, path, text):
    """Whole or not at all."""
    try:
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(path + ".part", path)
    except OSError as error:
        raise Failed("relief-lab %s: %s: %s" % (command, path, error.strerror)) from error
