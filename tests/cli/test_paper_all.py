"""All of the paper's experiments at their quick sizes: every measure holds."""

import unittest

from test_paper import Paper

ITEMS = ("fig1 fig2 fig3 fig4 fig5 fig6 fig7ab fig7cd fig10 weights fig8 fig11 mass-loss rival table1 all-at-once "
         "table2 adaptive readings").split()


class All(Paper):
    def test_all(self):
        self.singe("paper", "all", "--quick", "-o", self.path("page"), timeout=900)
        self.check_page("page", ITEMS)


def load_tests(loader, tests, pattern):
    return unittest.TestSuite([All("test_all")])


if __name__ == "__main__":
    unittest.main()
