# SPDX-License-Identifier: MIT
"""06_ros_yaml.py: ROS messages from a real pipeline's JSON lines against the scene's pose."""
import json
import math
import subprocess
import sys
import unittest

import yaml

PIPELINE = (
    "gst-launch-1.0 -q ellipsetestsrc scene=orbit num-buffers=12 ! ellipsetrack hfov=1.012 "
    "target-diameter=2 ! ellipsejson ! fdsink"
)
RECIPE = sys.argv.pop()


def messages_of(lines):
    text = subprocess.run(
        [sys.executable, RECIPE, "camera"], input=lines, capture_output=True, text=True, check=True
    ).stdout
    return [message for message in yaml.safe_load_all(text) if message is not None]


def axis_z_of(q):
    """The z axis after a rotation."""
    return (
        2.0 * (q["x"] * q["z"] + q["w"] * q["y"]),
        2.0 * (q["y"] * q["z"] - q["w"] * q["x"]),
        1.0 - 2.0 * (q["x"] ** 2 + q["y"] ** 2),
    )


class RosYaml(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.lines = subprocess.run(
            PIPELINE.split(), capture_output=True, text=True, check=True
        ).stdout
        cls.messages = messages_of(cls.lines)

    def targets(self):
        for text in self.lines.splitlines():
            line = json.loads(text)
            yield from ((line, t) for t in line["targets"] if t["role"] == "target")

    def test_writes_one_message_per_frame_with_its_pose(self):
        self.assertEqual(len(self.messages), 12)
        for message, (line, target) in zip(self.messages, self.targets()):
            stamp = message["header"]["stamp"]
            self.assertEqual(stamp["sec"] * 10**9 + stamp["nanosec"], line["pts_ns"])
            self.assertEqual(message["header"]["frame_id"], "camera")
            self.assertEqual(message["pose"]["pose"]["position"], target["position"])

    def test_orientation_maps_z_to_the_normal(self):
        for message, (_, target) in zip(self.messages, self.targets()):
            turn = message["pose"]["pose"]["orientation"]
            self.assertAlmostEqual(math.fsum(v * v for v in turn.values()), 1.0, places=5)
            for axis, name in zip(axis_z_of(turn), "xyz"):
                self.assertAlmostEqual(axis, target["normal"][name], places=5)

    def test_has_a_symmetric_covariance(self):
        for message, (_, target) in zip(self.messages, self.targets()):
            covariance = message["pose"]["covariance"]
            self.assertEqual(len(covariance), 36)
            rows = [covariance[6 * i : 6 * i + 6] for i in range(6)]
            self.assertEqual(rows, [list(row) for row in zip(*rows)])
            self.assertEqual(rows[0][:3], target["position_covariance"][:3])
            self.assertGreater(rows[2][2], 0.0)

    def test_writes_no_message_without_a_target(self):
        self.assertEqual(messages_of('{"frame":0,"pts_ns":0,"targets":[]}\n'), [])


if __name__ == "__main__":
    unittest.main()
