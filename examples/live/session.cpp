// SPDX-License-Identifier: MIT
#include "examples/live/session.hpp"

#include <iostream>
#include <utility>

namespace live {

Session::Session(const Options& options, std::function<void()> on_failure)
    : loops_(options.loops),
      store_([this] { on_change(); }),
      video_(store_, options.quality),
      pipeline_({.on_frame = [this](FramePtr frame) { on_frame(std::move(frame)); },
                 .on_trouble =
                     [this](const std::string& trouble) {
                       const std::string source = "source \"" + pipeline_.source().text + "\": ";
                       std::cerr << "ellipse-live: " << source
                                 << (trouble.empty() ? "recovered" : trouble) << std::endl;
                     },
                 .on_failure = std::move(on_failure)}),
      properties_(pipeline_.tracker(), CameraFolder(options.cameras)),
      review_(
          [this](const FramePtr& before, FramePtr after) { on_review(before, std::move(after)); }) {
  if (options.rtsp_port >= 0) {
    rtsp_.emplace(RtspOutput::Settings{options.bind, options.rtsp_port, options.token});
  }
  if (!options.record.empty()) {
    recorder_.emplace(options.record, [](const std::string& trouble) {
      std::cerr << "ellipse-live: the recording has stopped: " << trouble << std::endl;
    });
  }
}

void Session::on_frame(FramePtr frame) {
  if (rtsp_) rtsp_->put(frame);
  if (recorder_) recorder_->put(frame);
  history_.put(*frame);
  store_.put(std::move(frame));
}

void Session::open(const std::string& source, const std::string& fps) {
  SourceSpec spec =
      parse_source(source, fps.empty() ? std::nullopt : std::optional(parse_rate(fps)));
  pipeline_.close();
  // The old source's frames can no longer be held, analysed or labelled.
  store_.clear();
  history_.clear();
  pipeline_.open(std::move(spec), loops_);
}

void Session::play() {
  store_.release();
  pipeline_.play();
}

void Session::pause() {
  if (pipeline_.source().is_live) {
    store_.hold();
  } else {
    pipeline_.pause();
  }
}

void Session::step() {
  if (pipeline_.source().is_live) {
    store_.step();
  } else {
    store_.release();  // a frame of the history may be held
    pipeline_.step();
  }
}

bool Session::seek(GstClockTime position) {
  if (!pipeline_.is_seekable()) return false;
  store_.release();  // a frame of the history may be held
  return pipeline_.seek(position);
}

void Session::show(FramePtr frame) {
  pause();
  store_.show(std::move(frame));
}

bool Session::is_playing() const {
  return pipeline_.state() == PlayState::kPlaying && !store_.is_held();
}

void Session::review() {
  if (is_playing()) return;
  reviews_again_ = review_.is_busy();
  if (reviews_again_) return;
  if (const FramePtr frame = store_.newest()) review_.begin(frame, properties_);
}

// For a live source, RTSP continues to show the stream. A recording contains each picture once.
void Session::on_review(const FramePtr& before, FramePtr after) {
  const bool is_shown = after && store_.replace(before, after);
  if (is_shown && rtsp_ && !pipeline_.source().is_live) rtsp_->put(after);
  if (std::exchange(reviews_again_, false)) review();
}

void Session::on_change() {
  lines_.send(store_.take_lines());
  video_.update();
}

}  // namespace live
