// Changes between ticks: parameters, forces, objects; and queries.
#include "c/scene.h"
#include "c/session.h"

using namespace pliant::c;

namespace {

pliant::QueryOptions query_of_c(const pliant_query* query) {
  pliant::QueryOptions options;
  if (!query) return options;
  const pliant_query& c = sized(query, "query");
  if (c.object) options.object = c.object;
  options.rest = c.rest != 0;
  if (at_least_zero(c.within, "query->within") > 0.0) options.within = c.within;
  return options;
}

pliant_hit hit_to_c(const pliant::QueryHit& hit) {
  if (!hit.found()) return {sizeof(pliant_hit), 0, PLIANT_NONE, PLIANT_NONE, {}, {}, {}, 0.0};
  return {sizeof(pliant_hit), 1,           hit.object, hit.triangle, to_c(hit.barycentric), to_c(hit.position),
          to_c(hit.normal),   hit.distance};
}

}  // namespace

pliant_status pliant_session_set(pliant_session* session, const char* object, const char* key, double value) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.set(text(object, "object"), text(key, "key"), value));
  });
}

pliant_status pliant_session_set_word(pliant_session* session, const char* object, const char* key, const char* word) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.set(text(object, "object"), text(key, "key"), text(word, "word")));
  });
}

pliant_status pliant_session_set_values(pliant_session* session, const char* object, const char* key,
                                        const double* values, size_t count) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(values, "values");
    const std::vector<double> copy(values, values + count);
    check(of.session.set(text(object, "object"), text(key, "key"), copy));
  });
}

pliant_status pliant_session_get(pliant_session* session, const char* object, const char* key, double* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(out, "out") = taken(of.session.get(text(object, "object"), text(key, "key")));
  });
}

pliant_status pliant_session_slider_count(pliant_session* session, size_t* count) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { needed(count, "count") = of.session.sliders().size(); });
}

pliant_status pliant_session_slider(pliant_session* session, size_t index, pliant_slider* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    const std::vector<pliant::Slider>& all = of.session.sliders();
    throw_unless_below(index, all.size(), "");
    const pliant::Slider& s = all[index];
    *out = {sizeof *out, s.object.c_str(), s.key.c_str(), s.name.c_str(), s.unit.c_str(), s.low, s.high, s.step};
  });
}

pliant_status pliant_session_closest_point(pliant_session* session, pliant_vec3 point, const pliant_query* query,
                                           pliant_hit* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    *out = hit_to_c(taken(of.session.closest_point(of_c(point), query_of_c(query))));
  });
}

pliant_status pliant_session_ray(pliant_session* session, pliant_vec3 from, pliant_vec3 direction,
                                 const pliant_query* query, pliant_hit* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    sized(out, "out");
    *out = hit_to_c(taken(of.session.ray(of_c(from), of_c(direction), query_of_c(query))));
  });
}

pliant_status pliant_session_bounds(pliant_session* session, const pliant_query* query, pliant_vec3* min,
                                    pliant_vec3* max) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(min, "min");
    needed(max, "max");
    const pliant::Bounds bounds = taken(of.session.bounds(query_of_c(query)));
    *min = to_c(bounds.min);
    *max = to_c(bounds.max);
  });
}

pliant_status pliant_session_set_hand_force(pliant_session* session, const char* effector, pliant_wrench wrench) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.set_hand_force(text(effector, "effector"), of_c(wrench.force), of_c(wrench.torque)));
  });
}

pliant_status pliant_session_set_body_force(pliant_session* session, const char* body, pliant_wrench wrench) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.set_body_force(text(body, "body"), of_c(wrench.force), of_c(wrench.torque)));
  });
}

pliant_status pliant_session_set_point_force(pliant_session* session, const char* body, uint32_t vertex,
                                             pliant_vec3 force) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.set_point_force(text(body, "body"), vertex, of_c(force)));
  });
}

pliant_status pliant_session_push(pliant_session* session, const char* body, pliant_wrench impulse) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.push(text(body, "body"), of_c(impulse.force), of_c(impulse.torque)));
  });
}

pliant_status pliant_session_push_at(pliant_session* session, const char* body, uint32_t vertex, pliant_vec3 impulse) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { check(of.session.push_at(text(body, "body"), vertex, of_c(impulse))); });
}

pliant_status pliant_session_place(pliant_session* session, const char* object, pliant_pose pose) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    check(of.session.place(text(object, "object"), of_c(pose.position), of_c(pose.rotation)));
  });
}

pliant_status pliant_session_take_out(pliant_session* session, const char* object) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { check(of.session.take_out(text(object, "object"))); });
}

pliant_status pliant_session_put_back(pliant_session* session, const char* object) {
  return with_session(session, __func__,
                      [&](SessionHandle& of) { check(of.session.put_back(text(object, "object"))); });
}

pliant_status pliant_session_is_out(pliant_session* session, const char* object, int32_t* out) {
  return with_session(session, __func__, [&](SessionHandle& of) {
    needed(out, "out") = taken(of.session.is_out(text(object, "object")));
  });
}

pliant_status pliant_session_add(pliant_session* session, pliant_scene* more) {
  return with_devices(session, __func__, [&](SessionHandle& of) {
    const Held scene(more, HandleKind::kScene);
    throw_unless_held(scene, "more");
    check(of.session.add(static_cast<SceneHandle&>(*scene.slot().object).scene));
    of.read_names();
  });
}
