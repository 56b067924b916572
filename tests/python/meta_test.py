# SPDX-License-Identifier: MIT
"""GstEllipseMeta as Python sees it."""
import json
import sys
import unittest

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstEllipse", "1.0")
from gi.repository import GLib, Gst, GstEllipse  # noqa: E402

TARGET = GstEllipse.EllipseRole.TARGET
CANDIDATE = GstEllipse.EllipseRole.CANDIDATE
TRUTH = GstEllipse.EllipseRole.TRUTH


def buffer_with(*roles):
    """A buffer with an ellipse a role, numbered from 1 by its id."""
    buffer = Gst.Buffer.new_allocate(None, 16, None)
    for number, role in enumerate(roles, start=1):
        GstEllipse.buffer_add_ellipse_meta(buffer, role).id = number
    return buffer


class EllipseMeta(unittest.TestCase):
    def test_lists_all_in_their_order(self):
        ellipses = GstEllipse.buffer_list_ellipse_meta(buffer_with(TRUTH, TARGET, CANDIDATE))
        self.assertEqual([e.role for e in ellipses], [TRUTH, TARGET, CANDIDATE])
        self.assertEqual([e.id for e in ellipses], [1, 2, 3])

    def test_lists_nothing_on_an_empty_buffer(self):
        self.assertEqual(GstEllipse.buffer_list_ellipse_meta(buffer_with()), [])

    def test_gets_the_first_of_a_role_or_none(self):
        buffer = buffer_with(TRUTH, TARGET, TARGET)
        self.assertEqual(GstEllipse.buffer_get_ellipse_meta(buffer, TARGET).id, 2)
        self.assertIsNone(GstEllipse.buffer_get_ellipse_meta(buffer, CANDIDATE))

    def test_iterates(self):
        buffer = buffer_with(TRUTH, TARGET)
        ids = []
        ellipse, state = GstEllipse.buffer_iterate_ellipse_meta(buffer, None)
        while ellipse is not None:
            ids.append(ellipse.id)
            ellipse, state = GstEllipse.buffer_iterate_ellipse_meta(buffer, state)
        self.assertEqual(ids, [1, 2])

    def test_keeps_what_is_written(self):
        buffer = buffer_with(TARGET)
        written = GstEllipse.buffer_get_ellipse_meta(buffer, TARGET)
        self.assertEqual(written.pts, Gst.CLOCK_TIME_NONE)
        written.cx, written.roi_x, written.scale = 12.5, -3, 4
        written.id, written.pts = 2**40, 5 * Gst.SECOND
        written.state = GstEllipse.EllipseState.TRACKED
        read = GstEllipse.buffer_get_ellipse_meta(buffer, TARGET)
        self.assertEqual((read.cx, read.roi_x, read.scale), (12.5, -3, 4))
        self.assertEqual((read.id, read.pts), (2**40, 5 * Gst.SECOND))
        self.assertEqual((read.get_role_name(), read.get_state_name()), ("target", "tracked"))
        self.assertEqual(read.state.value_nick, "tracked")

    def test_follows_a_copy_of_the_buffer(self):
        copy = buffer_with(TRUTH, TARGET).copy_deep()
        self.assertEqual([e.id for e in GstEllipse.buffer_list_ellipse_meta(copy)], [1, 2])

    def test_structure_outlives_the_buffer(self):
        buffer = buffer_with(TRUTH, TARGET)
        structure = GstEllipse.buffer_get_ellipse_meta(buffer, TARGET).to_structure()
        del buffer
        self.assertEqual(structure.get_name(), "ellipse")
        self.assertEqual(structure.get_string("role"), "target")
        self.assertEqual(structure.get_uint64("id"), (True, 2))
        self.assertEqual(structure.get_value("semi_major"), 0.0)

    def test_json_is_that_of_the_lines(self):
        ellipse = GstEllipse.buffer_get_ellipse_meta(buffer_with(TARGET), TARGET)
        fields = json.loads(ellipse.to_json())
        self.assertEqual((fields["role"], fields["id"], fields["state"]), ("target", 1, "detected"))

    def test_is_counted_by_its_api(self):
        buffer = buffer_with(TRUTH, TARGET)
        self.assertEqual(buffer.get_n_meta(GstEllipse.ellipse_meta_api_get_type()), 2)
        self.assertEqual(Gst.Meta.get_info("GstEllipseMeta").size,
                         GstEllipse.EllipseMeta.get_info().size)


if __name__ == "__main__":
    Gst.init(None)
    # What the bindings complain of is a mistake in the annotations.
    GLib.log_set_always_fatal(GLib.LogLevelFlags.LEVEL_WARNING | GLib.LogLevelFlags.LEVEL_CRITICAL)
    result = unittest.main(exit=False).result
    # As the other suites do, for run.sh to count.
    with open("python.xml", "w", encoding="utf-8") as report:
        print(
            f'<testsuites tests="{result.testsRun}" failures="{len(result.failures)}"'
            f' errors="{len(result.errors)}"></testsuites>',
            file=report,
        )
    sys.exit(not result.wasSuccessful())
