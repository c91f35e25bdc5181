"""A line for each check, and whether all held."""


class Checks:
    """What was checked so far."""

    def __init__(self):
        self.failed = 0

    def hold(self, what, faults):
        """Says that something holds, or what is wrong with it."""
        self.failed += bool(faults)
        print(f"FAILED  {what}: {'; '.join(map(str, faults))}" if faults else f"ok      {what}",
              flush=True)

    def rejected(self, what, undetected):
        """Says that injected faults were found, or which were not."""
        self.hold(f"found when injected: {what}", [f"not found: {name}" for name in undetected])

    def exit_code(self):
        """For the shell."""
        return 1 if self.failed else 0
