"""The module says what it needs."""

import os
import subprocess
import sys
import unittest


class Import(unittest.TestCase):
    def test_without_numpy(self):
        hidden = "import sys; sys.modules['numpy'] = None; import polemcl"
        outcome = subprocess.run([sys.executable, "-c", hidden], env=os.environ, text=True,
                                 stderr=subprocess.PIPE, check=False)
        self.assertEqual(outcome.returncode, 1)
        self.assertIn("ImportError: polemcl needs NumPy", outcome.stderr)
        self.assertIn("apt install python3-numpy", outcome.stderr)


if __name__ == "__main__":
    unittest.main()
