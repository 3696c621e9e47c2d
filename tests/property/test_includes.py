"""Reads every source of the library and the programs. Checks the rules of share/doc/architecture.md: rooms
include only rooms above them, files stay small."""

import pathlib
import re
import unittest

TOP = pathlib.Path(__file__).parents[2]
PUBLIC = "libpolemcl/include/polemcl"
MOST_LINES = 500
# Rooms in the order of the document. A file may include headers of its own line and of the lines above. Rooms
# with the same first part belong to one big room.
ORDER = re.findall(r"^\| `([a-z_/]+)/` \|", (TOP / "share/doc/architecture.md").read_text(), re.M)

# Big rooms that a big room must not use, although they are above it.
STRANGERS = {"sim": {"mrpt"}}
# The laboratory: the big room that simulates. Only these rooms outside of it use it, and one more its settings,
# which the settings of all programs hold: one INI serves all programs.
LABORATORY, LABORATORY_USERS = "sim", {"apps/simulate", "apps/eval"}
LABORATORY_SETTINGS = ("apps/cli", "sim/common/SimulationOptions.h")
# A line above that a room must not use: two methods for the same purpose.
STRANGER_ROOMS = {"core/extraction/scan_line": {"core/extraction/range_image"}}
# Settings and report of the surrounding room, shared by its sub-rooms.
SHARED_HEADERS = {"core/extraction": {"CovarianceScale.h", "ExtractionOptions.h", "ExtractionReport.h",
                                      "PoleClassifier.h", "VisibilityRange.h"}}
# Public headers that stand above all rooms.
ABOVE_ROOMS = {"polemcl/export.h", "polemcl/version.h"}
# Libraries of the room core, beside the standard library, whose headers have no dot and no slash.
CORE_LIBRARIES = re.compile(r"[^./]*|(Eigen|hwy|ceres)/.*|nanoflann\.hpp")

HEADERS = {".h", ".hh", ".hpp", ".hxx", ".inl", ".ipp"}
SUFFIXES = HEADERS | {".c", ".cc", ".cpp", ".cxx", ".py", ".sh", ".in", ".js", ".cmake"}


def sources(*folders):
    """Paths from the top; share/demo/out is output of the demo, no source."""
    files = (path for folder in folders for path in sorted((TOP / folder).rglob("*")) if path.is_file())
    return [path.relative_to(TOP) for path in files if TOP / "share/demo/out" not in path.parents
            and (path.suffix in SUFFIXES or path.name == "CMakeLists.txt")]


def sources_in_rooms(*folders):
    """Without what the build reads, and the public headers that include all others."""
    return [path for path in sources(*folders) if path.name != "CMakeLists.txt" and str(path.parent) != PUBLIC]


def lines(path):
    return (TOP / path).read_text().splitlines()


def big(room):
    return room.split("/")[0]


def room_of(path):
    """The room of a file; empty for other files."""
    match = re.match(r"(?:libpolemcl/(?:src|include/polemcl)/|(?=apps/))(.*)/", str(path))
    return match[1] if match and match[1] in ORDER else ""


def room_of_header(header):
    folder = str(pathlib.PurePath(header.removeprefix("polemcl/")).parent)
    return folder if folder in ORDER else "apps/" + folder


def include_of(line):
    """The name between brackets or quotes, including them; empty if the line includes nothing."""
    match = re.match(r'\s*#\s*include\s*(<[^>]*>|"[^"]*"|\S+)', line)
    return match[1] if match else ""


def exists(header):
    """Whether there is such a private header, or the build makes it, from a template or rows of C++ from a table."""
    bases = (TOP / "libpolemcl/src", TOP / "libpolemcl/include", TOP / "apps")
    names = (header, header + ".in", re.sub(r"\.inc$", ".csv", header))
    return any((base / name).exists() for base in bases for name in names)


def may_include_own(room, header):
    target = room_of_header(header)
    if big(target) == LABORATORY and not (big(room) == LABORATORY or room in LABORATORY_USERS or
                                          (room, header) == LABORATORY_SETTINGS):
        return False
    if big(target) in STRANGERS.get(big(room), ()) or target in STRANGER_ROOMS.get(room, ()):
        return False
    if room.startswith(target + "/"):  # the surrounding room
        return pathlib.PurePath(header).name in SHARED_HEADERS.get(target, ())
    return target in ORDER[:ORDER.index(room) + 1]


def may_include_foreign(room, header):
    if big(room) == "core":
        return bool(CORE_LIBRARIES.fullmatch(header))
    if big(room) == "config":
        return not header.startswith("mrpt/") or header.startswith("mrpt/config/")
    return big(room) not in ("io", "sim") or not header.startswith("mrpt/")


def why_not(path, include):
    """Why a file may not include something (with brackets or quotes); empty if it may."""
    room, header = room_of(path), include[1:-1]
    quoted, ours = include[0] == '"', header.startswith("polemcl/")
    if not room:
        return "the file is in no room"
    if include[0] not in '<"':
        return "only plain includes can be checked"
    if quoted and str(path).startswith(PUBLIC):
        return "a public header includes public headers only"
    if quoted and (ours or not exists(header)):
        return "quotes are for private headers, by their path"
    if header in ABOVE_ROOMS:
        return ""
    if ours and str(pathlib.PurePath(header).parent.relative_to("polemcl")) not in ORDER:
        return "sources include the header they need, not all"
    if ours and not (TOP / "libpolemcl/include" / header).exists():
        return "there is no such public header"
    if quoted or ours:
        return "" if may_include_own(room, header) else f"it stands below the room {room}"
    return "" if may_include_foreign(room, header) else f"the room {room} does not use that library"


def violations(path, text):
    found = [(number, include_of(line)) for number, line in enumerate(text, 1) if include_of(line)]
    return [f"{path}:{number}: {include}: {why_not(path, include)}" for number, include in found
            if why_not(path, include)]


WRONG = r"""
libpolemcl/src/core/common/A.cpp #include "io/file/AtomicFile.h"
libpolemcl/src/core/common/A.cpp #include "core/sensor/SensorModel.h"
libpolemcl/src/core/common/A.cpp   #  include <mrpt/poses/CPose2D.h>  // why not
libpolemcl/src/core/common/A.cpp #include <zlib.h>
libpolemcl/src/core/common/A.cpp #include "../common/Types.h"
libpolemcl/src/core/common/A.cpp #include "Types.h"
libpolemcl/src/core/common/A.cpp #include "core/common/NoSuch.h"
libpolemcl/src/core/common/A.cpp #include SOMETHING
libpolemcl/src/core/extraction/scan_line/A.cpp #include "core/extraction/range_image/CircleFit.h"
libpolemcl/src/core/extraction/scan_line/A.cpp #include <polemcl/core/extraction/PoleExtractor.h>
libpolemcl/src/io/file/A.cpp #include <mrpt/poses/CPose2D.h>
libpolemcl/src/config/A.cpp #include <mrpt/poses/CPose2D.h>
libpolemcl/src/mrpt/map/A.cpp #include "sim/world/World.h"
libpolemcl/src/sim/world/A.cpp #include <polemcl/mrpt/map/CPoleMap.h>
libpolemcl/src/sim/world/A.cpp #include <mrpt/poses/CPose2D.h>
libpolemcl/src/report/scene/A.cpp #include "cli/CommandLine.h"
libpolemcl/src/report/scene/A.cpp #include "sim/world/World.h"
apps/localize/A.cpp #include "sim/drive/Simulation.h"
apps/cli/A.cpp #include "sim/world/World.h"
apps/map/A.cpp #include "sim/common/SimulationOptions.h"
libpolemcl/src/elsewhere/A.cpp #include <vector>
libpolemcl/include/polemcl/core/sensor/A.h #include "core/common/KdTree2D.h"
libpolemcl/include/polemcl/mrpt/map/A.h #include <polemcl/core/common/KdTree2D.h>
libpolemcl/src/mrpt/map/A.cpp #include <polemcl/polemcl.h>
apps/cli/A.cpp #include "map/MapApp.h"
"""
RIGHT = r"""
libpolemcl/src/core/sensor/A.cpp #include <polemcl/core/common/Types.h>
libpolemcl/src/core/extraction/A.cpp #include "core/extraction/scan_line/ScanLines.h"
libpolemcl/src/core/extraction/scan_line/A.cpp #include <polemcl/core/extraction/ExtractionOptions.h>
libpolemcl/src/core/common/A.cpp #include <Eigen/Dense>
libpolemcl/src/core/common/A.cpp #include <nanoflann.hpp>
libpolemcl/src/core/common/A.cpp // #include <mrpt/poses/CPose2D.h>
libpolemcl/src/io/file/A.cpp #include <zlib.h>
libpolemcl/src/config/A.cpp #include <mrpt/config/CConfigFileBase.h>
libpolemcl/src/mrpt/map/A.cpp #include "io/file/AtomicFile.h"
libpolemcl/src/sim/common/A.cpp #include "config/Config.h"
apps/eval/A.cpp #include "sim/world/World.h"
apps/cli/A.cpp #include "sim/common/SimulationOptions.h"
apps/map/A.cpp #include "map/MapApp.h"
libpolemcl/include/polemcl/core/common/A.h #include <polemcl/export.h>
"""


class Includes(unittest.TestCase):
    def test_wrong_includes_are_found_and_right_ones_left_alone(self):
        for count, table in ((1, WRONG), (0, RIGHT)):
            for path, line in (row.split(" ", 1) for row in table.strip().splitlines()):
                self.assertEqual(len(violations(path, ["", line])), count, f"{path} {line}")

    def test_rooms_include_only_what_stands_above_them(self):
        texts = {path: lines(path) for path in sources_in_rooms("libpolemcl", "apps")}
        self.assertEqual([each for path, text in texts.items() for each in violations(path, text)], [])
        self.assertGreater(sum(bool(include_of(line)) for text in texts.values() for line in text), 200)

    def test_every_source_is_in_a_room_and_every_room_has_sources(self):
        paths = sources_in_rooms("libpolemcl/src", "libpolemcl/include", "apps")
        self.assertEqual([path for path in paths if not room_of(path)], [])
        self.assertEqual({room_of(path) for path in paths}, set(ORDER))

    def test_headers_for_users_include_all_public_headers(self):
        """core.h has all of the room core, polemcl.h that and all else."""
        core, rest = ({include_of(line) for line in lines(f"{PUBLIC}/{name}.h")} - {""} for name in ("core", "polemcl"))
        public = {f"<{path.relative_to('libpolemcl/include')}>" for path in sources_in_rooms("libpolemcl/include")}
        self.assertEqual(core | rest, public | {"<polemcl/core.h>", "<polemcl/version.h>"})
        self.assertEqual({name for name in core if not name.startswith("<polemcl/core/")}, {"<polemcl/version.h>"})

    def test_no_source_is_long(self):
        paths = sources("libpolemcl", "apps", "tests", "share", "config")
        self.assertGreater(len(paths), 200)
        self.assertEqual([path for path in paths if len(lines(path)) > MOST_LINES], [])

    def test_headers_end_in_h_and_are_read_once(self):
        headers = [path for path in sources("libpolemcl", "apps", "tests") if path.suffix in HEADERS]
        self.assertEqual([path for path in headers if path.suffix != ".h" or "#pragma once" not in lines(path)], [])


if __name__ == "__main__":
    unittest.main()
