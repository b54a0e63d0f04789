"""singe validate at its quick sizes: every measure holds."""

import unittest

from test_paper import Paper

ITEMS = "heat umbrella front pmma beam disc kinetics ledgers".split()


class Validate(Paper):
    def test_all(self):
        self.singe("validate", "--quick", "-o", self.path("page"), timeout=900)
        self.check_page("page", ITEMS, bad_cases=False)

    def test_only(self):
        self.singe("validate", "--only", "kinetics", "-o", self.path("page"))
        self.check_page("page", ["kinetics"], bad_cases=False)
        _, err = self.singe("validate", "--only", "magic", expect=2)
        self.assertIn("there is no 'magic'", err)


def load_tests(loader, tests, pattern):
    return unittest.TestSuite([Validate("test_all"), Validate("test_only")])


if __name__ == "__main__":
    unittest.main()
