#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Converts the JSON lines of ellipsejson to ROS messages in YAML. Does not require ROS.

gst-launch-1.0 -q ... ! ellipsetrack hfov=1.012 target-diameter=1.5 ! ellipsejson ! fdsink |
  ./06_ros_yaml.py [FRAME_ID]

Writes one YAML document per frame with a visible target, in the format of
geometry_msgs/PoseWithCovarianceStamped for `rostopic pub` and `ros2 topic pub`. The pose's z axis
is the target's normal. The rotation about it is unknown: x is as close to the camera's x as
possible, and the variance is large.
"""
import json
import math
import signal
import sys

UNKNOWN = 1e6  # variance [rad^2]
TILT_VARIANCE = 0.01  # variance of the normal [rad^2]


def quaternion_to(normal):
    """The smallest rotation from z to the normal, as x, y, z, w."""
    x, y, z = normal["x"], normal["y"], normal["z"]
    if z < -0.999999:
        return 1.0, 0.0, 0.0, 0.0
    w = math.sqrt((1.0 + z) / 2.0)
    return -y / (2.0 * w), x / (2.0 * w), 0.0, w


def covariance_of(target):
    """6 x 6, row-major: x, y, z, rotation about x, y, z."""
    xx, xy, xz, yy, yz, zz = target["position_covariance"]
    rows = [[0.0] * 6 for _ in range(6)]
    rows[0][:3] = xx, xy, xz
    rows[1][:3] = xy, yy, yz
    rows[2][:3] = xz, yz, zz
    rows[3][3] = rows[4][4] = TILT_VARIANCE
    rows[5][5] = UNKNOWN
    return [value for row in rows for value in row]


def document(line, target, frame_id):
    position = target["position"]
    quat = quaternion_to(target["normal"])
    seconds, nanoseconds = divmod(line["pts_ns"], 1_000_000_000)
    covariance = ", ".join(f"{value:.6e}" for value in covariance_of(target))
    return (
        "header:\n"
        f"  stamp: {{sec: {seconds}, nanosec: {nanoseconds}}}\n"
        f"  frame_id: {frame_id}\n"
        "pose:\n"
        "  pose:\n"
        f"    position: {{x: {position['x']}, y: {position['y']}, z: {position['z']}}}\n"
        f"    orientation: {{x: {quat[0]:.9f}, y: {quat[1]:.9f}, z: {quat[2]:.9f}, w: {quat[3]:.9f}}}\n"
        f"  covariance: [{covariance}]\n"
        "---\n"
    )


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # ends quietly if its reader does, such as head
    frame_id = sys.argv[1] if len(sys.argv) > 1 else "camera_optical_frame"
    for text in sys.stdin:
        line = json.loads(text)
        for target in line["targets"]:
            is_visible = target["role"] == "target" and target["state"] != "predicted"
            if is_visible and "position" in target and line["pts_ns"] is not None:
                sys.stdout.write(document(line, target, frame_id))
                sys.stdout.flush()


if __name__ == "__main__":
    main()
