// What is seen of the surroundings through a body. A body of some thickness bends the ray twice, as if it were, right
// here, a ball whose diameter is the thickness: that alone needs no second surface, and it turns the world upside down
// as a drop does. A body without thickness is a pane: the ray goes straight on.

struct Through {
  float ior;         // [1]
  float thickness;   // [m] 0: a pane
  vec3 absorption;   // [1/m] Beer's law
};

vec3 seen_through(Surface s, Through t) {
  vec3 way = -s.to_eye;
  vec3 remains = vec3(1.0);
  if (t.thickness > 0.0) {
    vec3 inside = refract(way, s.normal, 1.0 / t.ior);
    float along = dot(s.normal, inside);               // < 0
    vec3 far_normal = s.normal - 2.0 * along * inside;  // of the ball, where the chord ends
    remains = exp(t.absorption * t.thickness * along);
    way = refract(inside, -far_normal, t.ior);          // never totally reflected: the angles are those of entry
  }
  // The blur of a rough surface fades as its index nears that of air.
  return remains * radiance_from(way, s.roughness * clamp(2.0 * t.ior - 2.0, 0.0, 1.0));
}
