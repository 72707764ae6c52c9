#include "editor/ui/host.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>

#include <algorithm>

#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"

namespace pliant::ui {
namespace {

constexpr double kDoubleClick = 0.4;  // [s] between two presses, by their arrival times

// Tab is excluded: it moves through every widget (seen.h).
constexpr struct {
  ImGuiKey_ ours;
  int theirs;
} kKeys[] = {{ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
             {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
             {ImGuiKey_UpArrow, GLFW_KEY_UP},
             {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
             {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
             {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
             {ImGuiKey_Home, GLFW_KEY_HOME},
             {ImGuiKey_End, GLFW_KEY_END},
             {ImGuiKey_Insert, GLFW_KEY_INSERT},
             {ImGuiKey_Delete, GLFW_KEY_DELETE},
             {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
             {ImGuiKey_Space, GLFW_KEY_SPACE},
             {ImGuiKey_Enter, GLFW_KEY_ENTER},
             {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
             {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
             {ImGuiKey_A, GLFW_KEY_A},
             {ImGuiKey_C, GLFW_KEY_C},
             {ImGuiKey_V, GLFW_KEY_V},
             {ImGuiKey_X, GLFW_KEY_X},
             {ImGuiKey_Y, GLFW_KEY_Y},
             {ImGuiKey_Z, GLFW_KEY_Z}};

}  // namespace

Host::Host(Window& window) : window_(window) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // the editor manages the layout
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  io.KeyMap[ImGuiKey_Tab] = -1;
  for (const auto& key : kKeys) io.KeyMap[key.ours] = key.theirs;
  io.ClipboardUserData = &window_;
  io.SetClipboardTextFn = [](void* w, const char* text) { static_cast<Window*>(w)->set_clipboard(text); };
  io.GetClipboardTextFn = [](void* w) {
    static std::string text;
    text = static_cast<Window*>(w)->clipboard();
    return text.c_str();
  };
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Host::~Host() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
}

void Host::set_theme(Theme theme, float scale) {
  missing_ = ui::set_theme(theme, scale);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Host::feed(const ArrivedInput& arrived) {
  ImGuiIO& io = ImGui::GetIO();
  const InputEvent& event = arrived.event;
  const auto modifiers = [&] {
    io.KeyShift = event.modifiers & kShift;
    io.KeyCtrl = event.modifiers & kControl;
    io.KeyAlt = event.modifiers & kAlt;
    io.KeySuper = event.modifiers & kSuper;
  };
  switch (event.kind) {
    case InputKind::kMove:
      mouse_ = {static_cast<float>(event.x), static_cast<float>(event.y)};
      break;
    case InputKind::kPress: {
      modifiers();
      const std::size_t button = static_cast<std::size_t>(event.button);
      io.MouseDown[button] = true;
      // Double clicks are detected by arrival times, not by slow frames.
      const bool twice = pressed_[button] >= 0 && arrived.time - pressed_[button] < kDoubleClick;
      io.MouseDoubleClickTime = twice ? 1e9f : 0.0f;
      pressed_[button] = arrived.time;
      break;
    }
    case InputKind::kRelease:
      io.MouseDown[static_cast<std::size_t>(event.button)] = false;
      break;
    case InputKind::kWheel:
      modifiers();
      io.MouseWheel += static_cast<float>(event.y);
      break;
    case InputKind::kKey:
    case InputKind::kKeyUp: {
      modifiers();
      const bool down = event.kind == InputKind::kKey;
      if (event.key >= 0 && event.key < static_cast<int>(std::size(io.KeysDown))) io.KeysDown[event.key] = down;
      // Dear ImGui activates buttons only with Space.
      if ((event.key == GLFW_KEY_ENTER || event.key == GLFW_KEY_KP_ENTER) &&
          (!down || (keyboard_has_focus() && !keyboard_is_on_field())))
        io.KeysDown[GLFW_KEY_SPACE] = down;
      // GLFW reports the state before a modifier's own key.
      if (event.key == GLFW_KEY_LEFT_SHIFT || event.key == GLFW_KEY_RIGHT_SHIFT) io.KeyShift = down;
      if (event.key == GLFW_KEY_LEFT_CONTROL || event.key == GLFW_KEY_RIGHT_CONTROL) io.KeyCtrl = down;
      if (event.key == GLFW_KEY_LEFT_ALT || event.key == GLFW_KEY_RIGHT_ALT) io.KeyAlt = down;
      break;
    }
    case InputKind::kText:
      draws(static_cast<unsigned>(event.key));
      io.AddInputCharacter(static_cast<unsigned>(event.key));
      break;
    case InputKind::kFocus:
      if (!event.key) std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
      io.AddFocusEvent(event.key != 0);
      break;
    case InputKind::kDrop:
    case InputKind::kClose:
    case InputKind::kWidget:
      break;
  }
}

std::vector<InputEvent> Host::begin(std::span<const InputEvent> events, double now, double dt) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(window_.width()), static_cast<float>(window_.height())};
  io.DeltaTime = static_cast<float>(std::clamp(dt, 1e-4, 1.0));
  io.MouseWheel = 0;
  queue_.add(events, now);
  std::vector<InputEvent> counts;
  for (ArrivedInput& arrived : queue_.take(io.WantTextInput)) {
    feed(arrived);
    counts.push_back(std::move(arrived.event));
  }
  io.MousePos = mouse_;
  if (fonts_lack_letters()) {
    missing_ = load_fonts(scale());
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  return counts;
}

void Host::end() {
  ImGui::Render();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glDisable(GL_FRAMEBUFFER_SRGB);  // its colours are already encoded
  glViewport(0, 0, window_.width(), window_.height());
  const ImVec4& back = palette().window;
  glClearColor(back.x, back.y, back.z, 1.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace pliant::ui
