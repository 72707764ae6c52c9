// A custom window: GLFW and OpenGL 3.3 draw the deformed surface. The mouse moves the probe over the ball; its left
// button presses. Usage: own_renderer [FRAMES], to stop after that many frames (the probe then presses automatically).
#include <epoxy/gl.h>
// GLFW must come after the OpenGL loader.
#include <GLFW/glfw3.h>
#include <pliant/pliant.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr float kRadius = 0.05f;  // [m]

// P1's two lines: the height displaces along the rest normal, and corrects the normal.
constexpr const char* kVertex = R"(#version 330
layout(location = 0) in vec3 P0;
layout(location = 1) in vec3 N0;
layout(location = 2) in vec4 s;  // the stream: nx, ny, nz, h
uniform mat4 to_clip;
out vec3 normal;
void main() {
  gl_Position = to_clip * vec4(P0 + s.w * N0, 1.0);
  normal = N0 + s.xyz;
})";
constexpr const char* kFragment = R"(#version 330
in vec3 normal;
out vec4 color;
void main() {
  float light = 0.25 + 0.75 * max(0.0, dot(normalize(normal), normalize(vec3(0.4, 0.8, 0.5))));
  color = vec4(light * vec3(0.85, 0.45, 0.38), 1.0);
})";

pliant::MeshData ball() {
  constexpr std::uint32_t kAround = 128, kAcross = 64;
  pliant::MeshData mesh;
  for (std::uint32_t j = 0; j <= kAcross; ++j)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const float up = 3.14159265f * float(j) / kAcross, round = 6.2831853f * float(i) / kAround;
      mesh.position.push_back(
          kRadius * pliant::vec3(std::sin(up) * std::cos(round), std::cos(up), std::sin(up) * std::sin(round)));
    }
  for (std::uint32_t j = 0; j < kAcross; ++j)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround, c = a + kAround, d = b + kAround;
      if (j > 0) mesh.index.insert(mesh.index.end(), {a, b, c});
      if (j + 1 < kAcross) mesh.index.insert(mesh.index.end(), {b, d, c});
    }
  return mesh;
}

GLuint program() {
  const GLuint made = glCreateProgram();
  for (const auto& [kind, text] : {std::pair(GL_VERTEX_SHADER, kVertex), std::pair(GL_FRAGMENT_SHADER, kFragment)}) {
    const GLuint shader = glCreateShader(GLenum(kind));
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(made, shader);
  }
  glLinkProgram(made);
  return made;
}

template <class T>
void attribute(GLuint place, GLint size, const std::vector<T>& values, GLenum usage) {
  GLuint buffer;
  glGenBuffers(1, &buffer);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(values.size() * sizeof(T)), values.data(), usage);
  glEnableVertexAttribArray(place);
  glVertexAttribPointer(place, size, GL_FLOAT, GL_FALSE, 0, nullptr);
}

int fail(const pliant::Error& error) {
  return std::fprintf(stderr, "%s\n", error.message().c_str()), 1;
}

}  // namespace

int main(int argc, char** argv) {
  const int frames = argc > 1 ? std::atoi(argv[1]) : 0;
  pliant::Scene scene("ball");
  scene.add_surface("ball", ball(), {.stiffness = 200.0, .reach = 0.03});
  scene.add_probe("finger", {.radius = 0.004});
  auto session = pliant::Session::open(scene);
  if (!session) return fail(session.error());
  const auto geometry = session->geometry("ball");
  if (!geometry) return fail(geometry.error());

  if (!glfwInit()) return std::fprintf(stderr, "no display; set DISPLAY\n"), 1;
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  GLFWwindow* const window = glfwCreateWindow(640, 640, "own renderer", nullptr, nullptr);
  if (!window) return std::fprintf(stderr, "no OpenGL 3.3\n"), 1;
  glfwMakeContextCurrent(window);
  const GLuint shaders = program();
  GLuint array, indices;
  glGenVertexArrays(1, &array);
  glBindVertexArray(array);
  attribute(0, 3, geometry->position, GL_STATIC_DRAW);
  attribute(1, 3, geometry->normal, GL_STATIC_DRAW);
  std::vector<pliant::vec4> stream, of_vertex(geometry->position.size());
  attribute(2, 4, of_vertex, GL_STREAM_DRAW);  // stays bound: refilled for every frame
  glGenBuffers(1, &indices);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(geometry->index.size() * 4), geometry->index.data(), GL_STATIC_DRAW);
  glEnable(GL_DEPTH_TEST);

  const auto at = [&](int frame) {  // target of the probe
    double x, y;
    glfwGetCursorPos(window, &x, &y);
    const bool press = frames > 0 || glfwGetMouseButton(window, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS;
    const pliant::dvec2 aim = frames > 0 ? pliant::dvec2(0.012) : pliant::dvec2(x / 320 - 1, 1 - y / 320) * 0.06;
    const double flat = std::sqrt(std::max(0.0, kRadius * kRadius - pliant::dot(aim, aim)));
    const double depth = frames > 0 ? std::min(0.012, 0.001 * frame) : 0.010;
    return pliant::dvec3(aim, flat + 0.004 - (press ? depth : -0.004));
  };
  if (auto moved = session->move("finger", at(0)); !moved) return fail(moved.error());
  if (auto started = session->start(); !started) return fail(started.error());
  double most = 0.0;
  for (int frame = 0; !glfwWindowShouldClose(window) && (frames == 0 || frame < frames); ++frame) {
    if (auto moved = session->move("finger", at(frame)); !moved) return fail(moved.error());
    if (auto got = session->stream("ball", stream); !got) return fail(got.error());
    for (std::size_t i = 0; i < of_vertex.size(); ++i) of_vertex[i] = stream[geometry->stream_vertex[i]];
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(of_vertex.size() * 16), of_vertex.data(), GL_STREAM_DRAW);
    int width, height;
    glfwGetFramebufferSize(window, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.12f, 0.13f, 0.15f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    // Front view, orthographic: 12 cm wide; nearer has smaller depth.
    const float s = 1 / 0.06f;
    const float to_clip[16] = {s, 0, 0, 0, 0, s, 0, 0, 0, 0, -s, 0, 0, 0, 0, 1};
    glUseProgram(shaders);
    glUniformMatrix4fv(glGetUniformLocation(shaders, "to_clip"), 1, GL_FALSE, to_clip);
    glDrawElements(GL_TRIANGLES, GLsizei(geometry->index.size()), GL_UNSIGNED_INT, nullptr);
    glfwSwapBuffers(window);
    glfwPollEvents();
    most = std::max(most, pliant::length(session->reading("finger")->force));
  }
  if (auto stopped = session->stop(); !stopped) return fail(stopped.error());
  std::printf("the largest force was %.3f N\n", most);
  glfwTerminate();
}
