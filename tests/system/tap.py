# What a system test needs to say how it went: numbered lines of the Test Anything Protocol.
# It counts, prints and knows nothing of what is tested.
#
# SPDX-License-Identifier: MIT
import sys


class Tap:
    def __init__(self):
        self.count = 0
        self.failures = 0

    def ok(self, fine, name, detail=""):
        """One line; `detail` is told only when it is not fine."""
        self.count += 1
        self.failures += not fine
        print("%sok %d - %s" % ("" if fine else "not ", self.count, name), flush=True)
        if not fine:
            for line in str(detail).splitlines()[:40]:
                print("#   " + line, flush=True)
        return fine

    def equal(self, found, expected, name):
        return self.ok(found == expected, name, "expected %.2000r\nfound    %.2000r" % (expected, found))

    def skip(self, name, reason):
        self.count += 1
        print("ok %d - %s # SKIP %s" % (self.count, name, reason), flush=True)

    def done(self):
        print("1..%d" % self.count)
        sys.exit(1 if self.failures else 0)
