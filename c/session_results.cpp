// Results of a session: readings, contacts, events, vertices, geometry, streams.
#include <algorithm>
#include <cstring>

#include "c/session.h"

using namespace pliant::c;

namespace pliant::c {

pliant_reading reading_to_c(const Reading& r) {
  return {sizeof(pliant_reading), r.ready,       r.touching,     r.object,       r.contacts, r.tick, r.time,
          to_c(r.position),       to_c(r.force), to_c(r.torque), to_c(r.normal), r.depth};
}

}  // namespace pliant::c

namespace {

pliant_contact contact_to_c(const pliant::ContactReading& c) {
  return {sizeof(pliant_contact), c.sliding,      c.object,      c.triangle, c.vertex,
          to_c(c.position),       to_c(c.normal), to_c(c.force), c.depth};
}

pliant_contact_side side_to_c(const pliant::ContactSide& side) {
  return {side.object, side.effector, side.triangle, side.vertex};
}

pliant_body_contact body_contact_to_c(const pliant::BodyContact& c) {
  return {sizeof(pliant_body_contact),
          c.sliding,
          side_to_c(c.a),
          side_to_c(c.b),
          to_c(c.position),
          to_c(c.normal),
          to_c(c.force),
          c.depth};
}

template <class T>
void copy_out(const ArrayOut<float>& to, const std::vector<T>& from, float* out) {
  static_assert(sizeof(T) == 3 * sizeof(float));
  if (to.fits(from.size()) && !from.empty()) std::memcpy(out, from.data(), from.size() * sizeof(T));
}

// Of triangles around each vertex, weighted by area; zero where there is none.
std::vector<pliant::vec3> normals_of(const std::vector<pliant::vec3>& positions,
                                     const std::vector<std::uint32_t>& triangles) {
  std::vector<pliant::dvec3> sums(positions.size(), pliant::dvec3(0));
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const std::uint32_t* const corner = &triangles[i];
    const pliant::dvec3 a(positions[corner[0]]), b(positions[corner[1]]), c(positions[corner[2]]);
    const pliant::dvec3 twice_area = cross(b - a, c - a);
    for (int k = 0; k < 3; ++k) sums[corner[k]] += twice_area;
  }
  std::vector<pliant::vec3> normals(positions.size(), pliant::vec3(0));
  for (std::size_t i = 0; i < sums.size(); ++i)
    if (const double size = length(sums[i]); size > 0.0) normals[i] = pliant::vec3(sums[i] / size);
  return normals;
}

}  // namespace

pliant_status pliant_session_reading(pliant_session* session, const char* effector, pliant_reading* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    *out = reading_to_c(taken(of.session.reading(text(effector, "effector"))));
  });
}

pliant_status pliant_session_contacts(pliant_session* session, const char* effector, pliant_contact* out,
                                      size_t capacity, size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    const pliant::Reading reading = taken(of.session.reading(text(effector, "effector")));
    if (!to.fits(reading.contacts)) return;
    for (std::size_t i = 0; i < reading.contacts; ++i) out[i] = contact_to_c(reading.contact[i]);
  });
}

pliant_status pliant_session_body_contacts(pliant_session* session, pliant_body_contact* out, size_t capacity,
                                           size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    std::vector<pliant::BodyContact> contacts;
    check(of.session.body_contacts(contacts));
    if (to.fits(contacts.size())) std::transform(contacts.begin(), contacts.end(), out, body_contact_to_c);
  });
}

pliant_status pliant_session_handles(pliant_session* session, pliant_handle_reading* out, size_t capacity,
                                     size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    std::vector<pliant::HandleReading> handles;
    check(of.session.handles(handles));
    if (!to.fits(handles.size())) return;
    for (const pliant::HandleReading& handle : handles) {
      const auto name = std::find(of.effectors.begin(), of.effectors.end(), handle.tool);
      *out++ = {sizeof *out,
                name == of.effectors.end() ? "" : name->c_str(),
                {to_c(handle.position), to_c(handle.rotation)},
                {to_c(handle.force), to_c(handle.torque)}};
    }
  });
}

pliant_status pliant_session_take_events(pliant_session* session, pliant_event* out, size_t capacity, size_t* count,
                                         uint64_t* lost) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    if (of.next_event == of.events.size()) {
      of.lost_events += of.session.take_events(of.events);
      of.next_event = 0;
    }
    const std::size_t taken_now = std::min(capacity, of.events.size() - of.next_event);
    of.sentences.resize(taken_now);
    for (std::size_t i = 0; i < taken_now; ++i) {
      const pliant::FeltEvent& event = of.events[of.next_event + i];
      of.sentences[i] = event.sentence();
      out[i] = {sizeof *out,
                static_cast<int32_t>(event.kind),
                event.index,
                event.tick,
                event.time,
                event.probe.c_str(),
                event.object.c_str(),
                event.layer.c_str(),
                of.sentences[i].c_str(),
                to_c(event.position),
                event.value};
    }
    of.next_event += taken_now;
    *count = taken_now;
    if (lost) *lost = std::exchange(of.lost_events, 0);
  });
}

pliant_status pliant_session_keep_readings(pliant_session* session, uint64_t ticks) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.keep_readings(ticks));
    of.readings.clear();
  });
}

pliant_status pliant_session_take_readings(pliant_session* session, const char* effector, pliant_reading* out,
                                           size_t capacity, size_t* count, uint64_t* lost) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    const std::string name = text(effector, "effector");
    SessionHandle::Readings& kept = of.readings[name];
    if (kept.next == kept.taken.size()) {
      kept.lost += taken(of.session.take_readings(name, kept.taken));
      kept.next = 0;
    }
    const std::size_t taken_now = std::min(capacity, kept.taken.size() - kept.next);
    for (std::size_t i = 0; i < taken_now; ++i) out[i] = reading_to_c(kept.taken[kept.next + i]);
    kept.next += taken_now;
    *count = taken_now;
    if (lost) *lost = std::exchange(kept.lost, 0);
  });
}

pliant_status pliant_session_figures(pliant_session* session, pliant_figures* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    const pliant::SessionFigures f = of.session.figures();
    *out = {sizeof *out, f.ticks, f.p50_us, f.p99_us, f.max_us, f.overruns, f.soft_steps};
  });
}

pliant_status pliant_session_find(pliant_session* session, size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(count, "count");
    of.findings = taken(of.session.findings());
    of.finding_texts.clear();
    for (const pliant::Note& note : of.findings) of.finding_texts.push_back(note.message());
    *count = of.findings.size();
  });
}

pliant_status pliant_session_finding(pliant_session* session, size_t index, pliant_note* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    throw_unless_below(index, of.findings.size(), "call pliant_session_find first");
    const pliant::Note& note = of.findings[index];
    *out = {sizeof *out, of.finding_texts[index].c_str(), note.code.c_str(), note.of.c_str()};
  });
}

pliant_status pliant_session_vertices(pliant_session* session, const char* object, float* out, size_t capacity,
                                      size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    check(of.session.vertices(text(object, "object"), of.positions));
    copy_out(to, of.positions, out);
  });
}

pliant_status pliant_session_normals(pliant_session* session, const char* object, float* out, size_t capacity,
                                     size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    check(of.session.vertices(text(object, "object"), of.positions));
    check(of.session.triangles(object, of.triangles));
    copy_out(to, normals_of(of.positions, of.triangles), out);
  });
}

pliant_status pliant_session_vertex_forces(pliant_session* session, const char* object, float* out, size_t capacity,
                                           size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    check(of.session.vertex_forces(text(object, "object"), of.positions));
    copy_out(to, of.positions, out);
  });
}

pliant_status pliant_session_triangles(pliant_session* session, const char* object, uint32_t* out, size_t capacity,
                                       size_t* count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    const ArrayOut to(out, capacity, count);
    check(of.session.triangles(text(object, "object"), of.triangles));
    if (to.fits(of.triangles.size())) std::copy(of.triangles.begin(), of.triangles.end(), out);
  });
}

pliant_status pliant_session_geometry(pliant_session* session, const char* object, pliant_geometry* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    pliant::Geometry geometry = taken(of.session.geometry(text(object, "object")));
    const pliant::Geometry& kept = of.drawn[object].geometry = std::move(geometry);
    *out = {sizeof *out,
            static_cast<uint32_t>(kept.position.size()),
            static_cast<uint32_t>(kept.index.size()),
            kept.position.empty() ? nullptr : &kept.position[0].x,
            kept.normal.empty() ? nullptr : &kept.normal[0].x,
            kept.shading_normal.empty() ? nullptr : &kept.shading_normal[0].x,
            kept.uv.empty() ? nullptr : &kept.uv[0].x,
            kept.stream_vertex.data(),
            kept.index.data()};
  });
}

pliant_status pliant_session_stream(pliant_session* session, const char* object, const float** stream, size_t* count,
                                    const pliant_range** changed, size_t* changed_count) {
  static_assert(sizeof(pliant::StreamPart) == sizeof(pliant_range));
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(stream, "stream");
    needed(count, "count");
    const std::string name = text(object, "object");
    const auto found = of.drawn.find(name);
    Drawn fresh, &to = found == of.drawn.end() ? fresh : found->second;
    check(of.session.stream(name, to.stream, to.changed));
    Drawn& kept = found == of.drawn.end() ? of.drawn[name] = std::move(fresh) : to;
    *stream = kept.stream.empty() ? nullptr : &kept.stream[0].x;
    *count = kept.stream.size();
    if (changed) *changed = reinterpret_cast<const pliant_range*>(kept.changed.data());
    if (changed_count) *changed_count = kept.changed.size();
  });
}

pliant_status pliant_session_to_world(pliant_session* session, const char* object, float* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(out, "out");
    const pliant::mat4 to_world = taken(of.session.to_world(text(object, "object")));
    std::memcpy(out, &to_world[0].x, sizeof to_world);
  });
}
