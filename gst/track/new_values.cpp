// SPDX-License-Identifier: MIT
#include "gst/track/new_values.hpp"

#include <exception>
#include <set>

namespace {

// Holds the object lock in a scope.
class ObjectLock {
 public:
  explicit ObjectLock(GstEllipseTrack* self) : object_(GST_OBJECT(self)) {
    GST_OBJECT_LOCK(object_);
  }
  ~ObjectLock() { GST_OBJECT_UNLOCK(object_); }
  ObjectLock(const ObjectLock&) = delete;
  ObjectLock& operator=(const ObjectLock&) = delete;

 private:
  GstObject* object_;
};

bool is_stopped(GstEllipseTrack* self) {
  return GST_STATE(self) == GST_STATE_NULL;
}

// @param kept  What keeps its value.
void warn_rejected(GstEllipseTrack* self, const std::string& error, const char* kept) {
  if (error.empty()) return;
  GST_WARNING_OBJECT(self, "setting rejected: %s", error.c_str());
  GST_ELEMENT_WARNING(
      self, LIBRARY, SETTINGS, ("Setting rejected: %s", error.c_str()), ("unchanged: %s", kept));
}

// @return Why the values are not valid together; empty if they are.
std::string validation_error(const TrackProperties& properties) {
  try {
    properties.tracker.validate();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

// Applies a change if the result is valid. In the state NULL an invalid combination is kept in
// `pending` and takes effect once another change makes it valid: the two values of a pair may be
// set in any order; start_error() reports the pair if it stays invalid.
// @return Why the change is rejected; empty if it is accepted or kept.
std::string changed(TrackShared& shared, const PropertyChange& change, bool is_stopped) {
  TrackProperties next = shared.preset.value_or(shared.properties);
  change.apply_to(next);
  if (shared.preset) {
    shared.preset = next;
    return "";
  }
  if (is_stopped) {
    if (!shared.pending) shared.pending = shared.properties;
    change.apply_to(*shared.pending);
    if (validation_error(*shared.pending).empty()) next = *shared.pending;
  }
  std::string error = validation_error(next);
  if (error.empty()) shared.properties = next;
  return is_stopped ? "" : error;
}

bool is_controlled(GstEllipseTrack* self, const GParamSpec* pspec) {
  GstControlBinding* binding = gst_object_get_control_binding(GST_OBJECT(self), pspec->name);
  if (binding == nullptr) return false;
  gst_object_unref(binding);
  return true;
}

// A rejected value that a controller sets at every frame is reported once, until a value is
// accepted again.
bool is_already_reported(GstEllipseTrack* self, const GParamSpec* pspec, bool is_rejected) {
  const bool is_repeated = is_controlled(self, pspec);
  const ObjectLock lock(self);
  std::set<std::string>& rejected = self->shared->rejected;
  const bool is_news = is_rejected ? rejected.insert(pspec->name).second : false;
  if (!is_rejected) rejected.erase(pspec->name);
  return is_repeated && !is_news;
}

// @return Why the value is rejected; empty if it is accepted.
std::string try_set(GstEllipseTrack* self, const char* name, const GValue* value) {
  TrackShared& shared = *self->shared;
  try {
    const PropertyChange change(name, value);  // may read a file
    const ObjectLock lock(self);
    std::string error = changed(shared, change, is_stopped(self));
    shared.value_errors.erase(name);
    return error;
  } catch (const std::exception& error) {
    const ObjectLock lock(self);
    if (is_stopped(self)) shared.value_errors[name] = error.what();
    return error.what();
  }
}

}  // namespace

void set_value(GstEllipseTrack* self, const GParamSpec* pspec, const GValue* value) {
  const std::string error = try_set(self, pspec->name, value);
  if (!is_already_reported(self, pspec, !error.empty())) warn_rejected(self, error, pspec->name);
}

gboolean load_together(GstEllipseTrack* self, const gchar* name, PresetLoader load_one_by_one) {
  TrackShared& shared = *self->shared;
  {
    const ObjectLock lock(self);
    shared.preset = shared.properties;
  }
  gboolean is_loaded = load_one_by_one(GST_PRESET(self), name);
  std::string error;
  {
    const ObjectLock lock(self);
    const TrackProperties loaded = shared.preset.value_or(shared.properties);
    shared.preset.reset();
    error = validation_error(loaded);
    if (!error.empty()) is_loaded = FALSE;
    if (is_loaded != FALSE) {
      shared.properties = loaded;
      shared.pending.reset();
      shared.value_errors.clear();
    }
  }
  warn_rejected(self, error, "all settings");
  return is_loaded;
}

std::string start_error(GstEllipseTrack* self) {
  TrackShared& shared = *self->shared;
  const ObjectLock lock(self);
  std::string error = shared.pending ? validation_error(*shared.pending) : "";
  if (!shared.value_errors.empty()) error = shared.value_errors.begin()->second;
  if (error.empty()) shared.pending.reset();
  return error;
}
