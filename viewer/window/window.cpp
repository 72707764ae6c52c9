#include "viewer/window/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <cstdlib>

#include "runtime/printable.h"
#include "viewer/window/display_loss.h"

namespace pliant {
namespace {

Window& window_of(GLFWwindow* handle) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(handle));
}

std::uint8_t modifiers_of(int mods) {
  return static_cast<std::uint8_t>((mods & GLFW_MOD_SHIFT ? kShift : 0) | (mods & GLFW_MOD_CONTROL ? kControl : 0) |
                                   (mods & GLFW_MOD_ALT ? kAlt : 0) | (mods & GLFW_MOD_SUPER ? kSuper : 0));
}

std::uint8_t modifiers_now(GLFWwindow* handle) {
  const auto down = [&](int left, int right) {
    return glfwGetKey(handle, left) == GLFW_PRESS || glfwGetKey(handle, right) == GLFW_PRESS;
  };
  return static_cast<std::uint8_t>((down(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT) ? kShift : 0) |
                                   (down(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL) ? kControl : 0) |
                                   (down(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT) ? kAlt : 0));
}

bool set(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}

std::string reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? std::string(" (") + text + ")" : std::string();
}

}  // namespace

bool Window::display_is_there() {
  return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

Result<std::unique_ptr<Window>> Window::create(int width, int height, const std::string& otherwise) {
  if (!display_is_there())
    return Error{"--window", "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set", "set one" + otherwise};
  watch_display();
  if (!glfwInit()) return Error{"--window", "the display cannot be reached" + reason(), "check DISPLAY" + otherwise};
  std::unique_ptr<Window> window(new Window());
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SAMPLES, 0);  // the renderer has its own multisampled buffers
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHintString(GLFW_X11_CLASS_NAME, "pliant");
  window->handle_ = glfwCreateWindow(width, height, "Pliant", nullptr, nullptr);
  if (!window->handle_)
    return Error{"--window", "the display gives no OpenGL 4.5 core context" + reason(),
                 "install libgl1-mesa-dri or the GPU's driver" + otherwise};
  watch_display();  // again, because GLFW has restored the previous handlers
  glfwMakeContextCurrent(window->handle_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window->handle_, window.get());
  connect(window->handle_);
  return window;
}

bool Window::lost() {
  return display_is_lost();
}

Error Window::loss() {
  return display_loss();
}

Window::~Window() {
  if (lost()) return;
  if (handle_) glfwDestroyWindow(handle_);
  glfwTerminate();
}

void Window::connect(GLFWwindow* handle) {
  glfwSetCursorPosCallback(handle, [](GLFWwindow* w, double x, double y) {
    int window_width = 1, window_height = 1;
    glfwGetWindowSize(w, &window_width, &window_height);
    const Window& window = window_of(w);
    window_of(w).add({.kind = InputKind::kMove,
                      .x = x * window.width() / std::max(window_width, 1),
                      .y = y * window.height() / std::max(window_height, 1)});
  });
  glfwSetMouseButtonCallback(handle, [](GLFWwindow* w, int button, int action, int mods) {
    if (button > GLFW_MOUSE_BUTTON_MIDDLE) return;
    window_of(w).add({.kind = action == GLFW_PRESS ? InputKind::kPress : InputKind::kRelease,
                      .button = static_cast<MouseButton>(button),
                      .modifiers = modifiers_of(mods)});
  });
  glfwSetScrollCallback(handle, [](GLFWwindow* w, double, double clicks) {
    window_of(w).add({.kind = InputKind::kWheel, .y = clicks, .modifiers = modifiers_now(w)});
  });
  glfwSetKeyCallback(handle, [](GLFWwindow* w, int key, int, int action, int mods) {
    window_of(w).add({.kind = action == GLFW_RELEASE ? InputKind::kKeyUp : InputKind::kKey,
                      .key = key,
                      .repeated = action == GLFW_REPEAT,
                      .modifiers = modifiers_of(mods)});
  });
  glfwSetCharCallback(handle, [](GLFWwindow* w, unsigned code_point) {
    window_of(w).add({.kind = InputKind::kText, .key = static_cast<int>(code_point)});
  });
  glfwSetWindowFocusCallback(
      handle, [](GLFWwindow* w, int focused) { window_of(w).add({.kind = InputKind::kFocus, .key = focused}); });
  glfwSetDropCallback(handle, [](GLFWwindow* w, int count, const char** files) {
    if (count > 0) window_of(w).add({.kind = InputKind::kDrop, .file = files[0], .files = {files, files + count}});
  });
  glfwSetWindowCloseCallback(handle, [](GLFWwindow* w) { window_of(w).add({.kind = InputKind::kClose}); });
}

void Window::show(const std::string& title) {
  glfwSetWindowTitle(handle_, printable(title).c_str());
  glfwShowWindow(handle_);
}

void Window::poll(std::vector<InputEvent>& events, double longest) {
  glfwWaitEventsTimeout(longest);
  events.insert(events.end(), events_.begin(), events_.end());
  events_.clear();
}

void Window::wake() {
  glfwPostEmptyEvent();
}

void Window::give_context() {
  glfwMakeContextCurrent(nullptr);
}

void Window::take_context() {
  glfwMakeContextCurrent(handle_);
}

void Window::present() {
  glfwSwapBuffers(handle_);
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(handle_);
  return text ? text : "";
}

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(handle_, text.c_str());
}

Result<std::unique_ptr<SharedContext>> Window::share() {
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  std::unique_ptr<SharedContext> context(new SharedContext());
  context->handle_ = glfwCreateWindow(1, 1, "Pliant", nullptr, handle_);
  if (!context->handle_)
    return Error{"window", "the display gives no second OpenGL context" + reason(), "update the GPU's driver"};
  return context;
}

SharedContext::~SharedContext() {
  if (handle_ && !Window::lost()) glfwDestroyWindow(handle_);
}

void SharedContext::take() {
  glfwMakeContextCurrent(handle_);
}

void SharedContext::give() {
  glfwMakeContextCurrent(nullptr);
}

void Window::hide_cursor(bool hidden) {
  if (hidden == cursor_hidden_) return;
  cursor_hidden_ = hidden;
  glfwSetInputMode(handle_, GLFW_CURSOR, hidden ? GLFW_CURSOR_HIDDEN : GLFW_CURSOR_NORMAL);
}

int Window::width() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(handle_, &width, &height);
  return lost() ? 1 : std::max(width, 1);  // undefined after the loss of the display
}

int Window::height() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(handle_, &width, &height);
  return lost() ? 1 : std::max(height, 1);
}

float Window::scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(handle_, &x, &y);
  return std::clamp(std::max(x, y), 1.0f, 4.0f);
}

}  // namespace pliant
