#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Prints the ellipses of each frame from a pad probe, until the stream ends or Ctrl-C.

  ./03_probe.py                            a rendered landing
  ./03_probe.py "v4l2src ! videoconvert"   a camera, or any source in gst-launch-1.0 syntax

To use an uninstalled build, run it in `meson devenv -C build -w .`.
"""
import signal
import sys
from itertools import count

try:
    import gi

    gi.require_version("Gst", "1.0")
    gi.require_version("GstEllipse", "1.0")
except ImportError as error:
    sys.exit(f"{error}: install python3-gi and run this with /usr/bin/python3")
except ValueError as error:
    sys.exit(f"{error}: is it installed, or GI_TYPELIB_PATH set?")
from gi.repository import GLib, Gst, GstEllipse  # noqa: E402


def on_buffer(_pad, info, frames):
    # An ellipse is valid only with its buffer: read it here, or keep ellipse.to_structure().
    frame = next(frames)
    ellipses = GstEllipse.buffer_list_ellipse_meta(info.get_buffer())
    for ellipse in ellipses:
        is_truth = ellipse.role == GstEllipse.EllipseRole.TRUTH
        print(
            f"frame {frame:4}  {ellipse.get_role_name():9}"
            f"  {'' if is_truth else ellipse.get_state_name():9}"
            f"  centre {ellipse.cx:7.2f} {ellipse.cy:7.2f}"
            f"  semi-axes {ellipse.semi_major:6.2f} {ellipse.semi_minor:6.2f}"
            f"  angle {ellipse.angle_rad:6.3f}",
            flush=True,
        )
    if not ellipses:
        print(f"frame {frame:4}  nothing", flush=True)
    return Gst.PadProbeReturn.OK


def run(pipeline):
    """Runs a pipeline until it ends; returns the error message, or None."""
    loop = GLib.MainLoop()
    failures = []

    def on_error(_bus, message):
        failures.append(f"{message.src.get_path_string()}: {message.parse_error()[0].message}")
        loop.quit()

    bus = pipeline.get_bus()
    bus.add_signal_watch()
    bus.connect("message::error", on_error)
    bus.connect("message::eos", lambda *_: loop.quit())
    GLib.unix_signal_add(GLib.PRIORITY_DEFAULT, signal.SIGINT, loop.quit)
    pipeline.set_state(Gst.State.PLAYING)
    loop.run()
    pipeline.set_state(Gst.State.NULL)
    bus.remove_signal_watch()
    return failures[0] if failures else None


def main():
    Gst.init(None)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # exit silently in ./03_probe.py | head
    if not Gst.ElementFactory.find("ellipsetrack"):
        sys.exit("no element ellipsetrack: is gst-ellipse installed, or GST_PLUGIN_PATH set?")
    source = sys.argv[1] if len(sys.argv) > 1 else "ellipsetestsrc num-buffers=60"
    try:
        pipeline = Gst.parse_launch(f"{source} ! ellipsetrack name=track ! fakesink")
    except GLib.Error as error:
        sys.exit(error.message)
    pad = pipeline.get_by_name("track").get_static_pad("src")
    pad.add_probe(Gst.PadProbeType.BUFFER, on_buffer, count())
    sys.exit(run(pipeline))


if __name__ == "__main__":
    main()
