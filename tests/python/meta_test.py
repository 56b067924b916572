# SPDX-License-Identifier: MIT
"""The metadata and the elements through the Python bindings."""
import json
import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstEllipse", "1.0")
from gi.repository import GLib, GObject, Gst, GstEllipse  # noqa: E402

TARGET = GstEllipse.EllipseRole.TARGET
CANDIDATE = GstEllipse.EllipseRole.CANDIDATE
TRUTH = GstEllipse.EllipseRole.TRUTH


def buffer_with(*roles):
    """A buffer with one ellipse per role; ids count from 1."""
    buffer = Gst.Buffer.new_allocate(None, 16, None)
    for number, role in enumerate(roles, start=1):
        GstEllipse.buffer_add_ellipse_meta(buffer, role).id = number
    return buffer


class EllipseMeta(unittest.TestCase):
    def test_lists_all_in_insertion_order(self):
        ellipses = GstEllipse.buffer_list_ellipse_meta(buffer_with(TRUTH, TARGET, CANDIDATE))
        self.assertEqual([e.role for e in ellipses], [TRUTH, TARGET, CANDIDATE])
        self.assertEqual([e.id for e in ellipses], [1, 2, 3])

    def test_lists_nothing_on_an_empty_buffer(self):
        self.assertEqual(GstEllipse.buffer_list_ellipse_meta(buffer_with()), [])

    def test_gets_the_first_of_a_role(self):
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

    def test_written_fields_are_read_back(self):
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

    def test_reports_the_tracker_state(self):
        buffer = buffer_with()
        search = GstEllipse.buffer_add_ellipse_search_meta(buffer, 5)
        self.assertEqual(search.get_tracker_state_name(), "unknown")
        search.tracker_state = GstEllipse.EllipseTrackerState.CONFIRMING
        read = GstEllipse.buffer_get_ellipse_search_meta(buffer)
        self.assertEqual(read.get_tracker_state_name(), "confirming")
        line = json.loads(GstEllipse.buffer_ellipses_to_json(buffer, 0, 320, 240))
        self.assertEqual((line["processing_ns"], line["tracker"]), (5, "confirming"))

    def test_is_copied_with_the_buffer(self):
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

    def test_json_matches_the_lines(self):
        ellipse = GstEllipse.buffer_get_ellipse_meta(buffer_with(TARGET), TARGET)
        fields = json.loads(ellipse.to_json())
        self.assertEqual((fields["role"], fields["id"], fields["state"]), ("target", 1, "detected"))

    def test_is_counted_by_its_api(self):
        buffer = buffer_with(TRUTH, TARGET)
        self.assertEqual(buffer.get_n_meta(GstEllipse.ellipse_meta_api_get_type()), 2)
        self.assertEqual(Gst.Meta.get_info("GstEllipseMeta").size,
                         GstEllipse.EllipseMeta.get_info().size)


class SearchRegion(unittest.TestCase):
    """ellipsetrack's property roi, a GstValueArray of four ints."""

    def setUp(self):
        self.track = Gst.ElementFactory.make("ellipsetrack")

    def region(self):
        is_array, four = Gst.util_get_object_array(self.track, "roi")
        self.assertTrue(is_array)
        return [four.get_nth(i) for i in range(four.n_values)]

    def test_is_written_as_text_and_read_as_numbers(self):
        self.assertEqual(self.region(), [0, 0, 0, 0])
        Gst.util_set_object_arg(self.track, "roi", "<10,-20,300,200>")
        self.assertEqual(self.region(), [10, -20, 300, 200])

    def test_is_written_as_numbers(self):
        four = GObject.ValueArray.new(4)
        for number in (1, 2, 30, 40):
            four.append(number)
        self.assertTrue(Gst.util_set_object_array(self.track, "roi", four))
        self.assertEqual(self.region(), [1, 2, 30, 40])

    def targets_inside(self, region):
        pipeline = Gst.parse_launch(
            "ellipsetestsrc num-buffers=5 ! ellipsetrack name=track roi-source=property"
            " ! appsink name=sink sync=false")
        Gst.util_set_object_arg(pipeline.get_by_name("track"), "roi", region)
        pipeline.set_state(Gst.State.PLAYING)
        sink = pipeline.get_by_name("sink")
        found = []
        while (sample := sink.emit("pull-sample")) is not None:
            ellipse = GstEllipse.buffer_get_ellipse_meta(sample.get_buffer(), TARGET)
            if ellipse is not None:
                found.append((ellipse.cx, ellipse.cy))
        pipeline.set_state(Gst.State.NULL)
        return found

    def test_limits_the_search(self):
        inside = self.targets_inside("<200,100,300,200>")
        self.assertEqual(len(inside), 5)
        self.assertAlmostEqual(inside[0][0], 319.8, delta=0.5)
        self.assertEqual(self.targets_inside("<0,0,100,100>"), [])


class Reference(unittest.TestCase):
    """The GIR file from which the API reference is generated."""

    def test_every_symbol_has_a_since_version(self):
        gir = ElementTree.parse(os.environ["ELLIPSE_GIR"])
        core = "{http://www.gtk.org/introspection/core/1.0}"
        namespace = gir.find(f"{core}namespace")
        kinds = ("function", "method", "constructor", "record", "enumeration", "bitfield", "class")
        symbols = [symbol for kind in kinds for symbol in namespace.iter(core + kind)]
        self.assertGreater(len(symbols), 15)
        without = [symbol.get("name") for symbol in symbols if symbol.get("version") is None]
        self.assertEqual(without, [])


if __name__ == "__main__":
    Gst.init(None)
    # A warning of the bindings is a mistake in the annotations.
    GLib.log_set_always_fatal(GLib.LogLevelFlags.LEVEL_WARNING | GLib.LogLevelFlags.LEVEL_CRITICAL)
    result = unittest.main(exit=False).result
    # run.sh counts the tests in this report, as in those of gtest.
    with open("python.xml", "w", encoding="utf-8") as report:
        print(
            f'<testsuites tests="{result.testsRun}" failures="{len(result.failures)}"'
            f' errors="{len(result.errors)}"></testsuites>',
            file=report,
        )
    sys.exit(not result.wasSuccessful())
