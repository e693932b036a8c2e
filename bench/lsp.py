#!/usr/bin/env python3
"""How long `rtlang --lsp` takes from a change in a scene of 10 000 lines to its messages, as an editor sees it.

Usage: lsp.py [CHANGES]; 50 by default. Each change is one line, and the client sends the whole text, as the server asks for it.
Printed are the median, the time that nine of ten changes keep, and the longest; exit status 1 when the median is not
below 100 ms. SPDX-License-Identifier: MIT
"""
import os
import statistics
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "system"))
import lsp_client  # noqa: E402


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    client = lsp_client.Client("/tmp")
    client.ask("initialize", {"processId": None, "rootUri": None, "capabilities": {}})
    client.notify("initialized", {})
    took = [1000 * each for each in lsp_client.seconds_of_changes(client, "file:///tmp/large.scn", count)]
    client.ask("shutdown")
    client.notify("exit", None)
    client.close()
    print(f"| a change in 10 000 lines to its messages, ms, {count} changes | median | nine of ten | longest |\n|---|---|---|---|\n"
          f"| --lsp | {statistics.median(took):.1f} | {took[int(0.9 * count)]:.1f} | {took[-1]:.1f} |")
    return statistics.median(took) >= 100


if __name__ == "__main__":
    sys.exit(main())
