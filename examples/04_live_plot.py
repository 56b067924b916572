#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plots the target's centre live, until the window is closed or Ctrl-C.

  ./04_live_plot.py                            a rendered landing
  ./04_live_plot.py "v4l2src ! videoconvert"   a camera, or any source in gst-launch-1.0 syntax
  ./04_live_plot.py --save centre.png          no window; runs at full speed, saves the plot

To use an uninstalled build, run it in `meson devenv -C build -w .`.
"""
import argparse
import math
import signal
import sys
import threading
from collections import deque

try:
    import gi

    gi.require_version("Gst", "1.0")
    gi.require_version("GstEllipse", "1.0")
except ImportError as error:
    sys.exit(f"{error}: install python3-gi and run this with /usr/bin/python3")
except ValueError as error:
    sys.exit(f"{error}: is it installed, or GI_TYPELIB_PATH set?")
from gi.repository import GLib, Gst, GstEllipse  # noqa: E402

try:
    from matplotlib import pyplot
except ImportError as error:
    sys.exit(f"{error}: install python3-matplotlib")

MAX_FRAMES = 1800  # one minute at 30 Hz; older frames are dropped
REDRAW_S = 0.05
TRUTH, TARGET = GstEllipse.EllipseRole.TRUTH, GstEllipse.EllipseRole.TARGET
STYLES = {
    TRUTH: dict(label="truth", color="0.75", linewidth=5.0, solid_capstyle="round"),
    TARGET: dict(label="target", color="tab:green", linewidth=1.5),
}


class Trail:
    """Time [s] and centres [px] by role of recent frames. Filled by the streaming thread."""

    def __init__(self):
        self.frames = deque(maxlen=MAX_FRAMES)
        self.frame_size = 0, 0

    def on_buffer(self, _pad, info):
        buffer = info.get_buffer()
        centres = {}
        for role in STYLES:
            ellipse = GstEllipse.buffer_get_ellipse_meta(buffer, role)
            if ellipse is not None:
                centres[role] = ellipse.cx, ellipse.cy
                self.frame_size = ellipse.frame_width, ellipse.frame_height
        self.frames.append((buffer.pts / Gst.SECOND, centres))
        return Gst.PadProbeReturn.OK

    def summary(self):
        """Counts frames with a target and, if the truth is known, the maximum centre error."""
        found = sum(TARGET in centres for _, centres in self.frames)
        errors = [math.dist(*c.values()) for _, c in self.frames if len(c) == len(STYLES)]
        off = f", maximum centre error {max(errors):.2f} px" if errors else ""
        return f"{len(self.frames)} frames, target in {found}{off}"


class Plot:
    """Plots the centre's path in the picture, and its x and y over time."""

    def __init__(self):
        self.figure, axes = pyplot.subplot_mosaic(
            [["path", "x"], ["path", "y"]], figsize=(11, 4.5), layout="constrained"
        )
        self.path, self.x, self.y = axes["path"], axes["x"], axes["y"]
        self.path.set_title("centre in the picture", loc="left")
        self.path.set(xlabel="x [px]", ylabel="y [px]", aspect=1)
        self.x.set_title("centre over time", loc="left")
        self.x.set(ylabel="x [px]")
        self.y.set(xlabel="time [s]", ylabel="y [px]")
        self.x.sharex(self.y)
        self.lines = {
            role: [axis.plot([], [], **style)[0] for axis in (self.path, self.x, self.y)]
            for role, style in STYLES.items()
        }
        for axis in axes.values():
            axis.grid(alpha=0.3)
        self.path.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=2, frameon=False)

    def draw(self, trail):
        frames = list(trail.frames)
        width, height = trail.frame_size
        if width > 0:
            self.path.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))  # y down
        times = [time for time, _ in frames]
        gap = math.nan, math.nan
        for role, (path, curve_x, curve_y) in self.lines.items():
            x = [centres.get(role, gap)[0] for _, centres in frames]
            y = [centres.get(role, gap)[1] for _, centres in frames]
            path.set_data(x, y)
            curve_x.set_data(times, x)
            curve_y.set_data(times, y)
        for axis in (self.x, self.y):
            axis.relim()
            axis.autoscale_view()
        self.figure.canvas.draw_idle()


def play(pipeline, plot, trail, has_window):
    """Runs until the stream ends or the window is closed; returns the error message, or None."""
    interrupted = threading.Event()
    signal.signal(signal.SIGINT, lambda *_: interrupted.set())
    if has_window:
        pyplot.show(block=False)
    bus = pipeline.get_bus()
    pipeline.set_state(Gst.State.PLAYING)
    while not interrupted.is_set() and pyplot.fignum_exists(plot.figure.number):
        timeout = 0 if has_window else int(REDRAW_S * Gst.SECOND)
        message = bus.timed_pop_filtered(timeout, Gst.MessageType.ERROR | Gst.MessageType.EOS)
        if message and message.type == Gst.MessageType.ERROR:
            return f"{message.src.get_path_string()}: {message.parse_error()[0].message}"
        if has_window:
            plot.draw(trail)
            plot.figure.canvas.start_event_loop(REDRAW_S)
        elif message:
            break
    return None


def main():
    Gst.init(None)
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", nargs="?", default="ellipsetestsrc num-buffers=300")
    parser.add_argument("--save", metavar="PNG")
    options = parser.parse_args()
    if not Gst.ElementFactory.find("ellipsetrack"):
        sys.exit("no element ellipsetrack: is gst-ellipse installed, or GST_PLUGIN_PATH set?")
    sink = "fakesink" if options.save else "fakesink sync=true"
    try:
        pipeline = Gst.parse_launch(f"{options.source} ! ellipsetrack name=track ! {sink}")
    except GLib.Error as error:
        sys.exit(error.message)
    if options.save:
        pyplot.switch_backend("agg")

    trail, plot = Trail(), Plot()
    if not options.save and pyplot.get_backend().lower() == "agg":
        sys.exit("no display available: save the plot to a file with --save")
    pad = pipeline.get_by_name("track").get_static_pad("src")
    pad.add_probe(Gst.PadProbeType.BUFFER, trail.on_buffer)
    failure = play(pipeline, plot, trail, has_window=not options.save)
    pipeline.set_state(Gst.State.NULL)
    if failure:
        sys.exit(failure)
    print(trail.summary())
    if options.save:
        plot.draw(trail)
        try:
            plot.figure.savefig(options.save, dpi=120)
        except (OSError, ValueError) as error:
            sys.exit(str(error))


if __name__ == "__main__":
    main()
