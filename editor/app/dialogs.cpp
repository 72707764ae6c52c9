// The program's questions, and lines over the viewport.
#include <fmt/format.h>

#include <algorithm>

#include "editor/app/app.h"
#include "editor/app/files.h"
#include "runtime/printable.h"
#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kLongOpening = 0.3;  // [s] what opens sooner shows no dialog

}  // namespace

void App::ask(Question question) {
  questions_.push_back(std::move(question));
}

void App::ask_to_leave() {
  if (!after_leaving_) return;
  const ui::Scope scope("Unsaved");
  ImGui::OpenPopup("Unsaved changes");
  ImGui::SetNextWindowPos({0.5f * ImGui::GetIO().DisplaySize.x, 0.4f * ImGui::GetIO().DisplaySize.y}, ImGuiCond_Always,
                          {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(
          "Unsaved changes", nullptr,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove))
    return;
  ui::title("Save the changes?");
  ui::gap();
  ImGui::TextUnformatted(
      fmt::format("{} has changes that are in no file.", printable(editor.document.title())).c_str());
  ui::gap(ui::kPad);
  const auto go = [&] {
    auto then = std::exchange(after_leaving_, nullptr);
    ImGui::CloseCurrentPopup();
    then();
  };
  const bool saves = ui::strong_button("Save", nullptr, true, 110);
  if (ImGui::IsWindowAppearing()) {
    ImGui::SetItemDefaultFocus();
    ui::lead_by_keyboard();
  }
  if (saves) {
    if (editor.document.file().empty()) {
      auto then = std::exchange(after_leaving_, nullptr);
      ImGui::CloseCurrentPopup();
      files_->save_as(std::move(then));
    } else if (save()) {
      go();
    }
  }
  ImGui::SameLine();
  if (ui::button("Discard", "Undo could not bring them back.", true, 110)) go();
  ImGui::SameLine();
  if (ui::button("Cancel", "Esc", true, 110) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
    after_leaving_ = nullptr;
    wants_out_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void App::draw_question() {
  if (questions_.empty() || after_leaving_) return;
  const ui::Scope scope("Question");
  ImGui::OpenPopup("Question");
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.4f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({ui::px(360), 0}, {0.8f * size.x, 0.8f * size.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kWide), ui::px(ui::kWide)));
  const bool open = ImGui::BeginPopupModal(
      "Question", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove);
  ImGui::PopStyleVar();
  if (!open) return;
  const Question& question = questions_.front();
  ui::title(printable(question.title).c_str());
  ui::gap(ui::kGap);
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::min(ui::px(560), 0.7f * size.x));
  for (const std::string& line : question.lines) {
    ui::draws(line);
    ImGui::TextUnformatted(printable(line).c_str());
  }
  ImGui::PopTextWrapPos();
  ui::gap(ui::kPad);
  const Answer* taken = nullptr;
  for (const Answer& answer : question.answers) {
    if (&answer != &question.answers.front()) ImGui::SameLine();
    const bool first = &answer == &question.answers.front();
    if (first ? ui::strong_button(answer.label.c_str(), answer.hint.c_str())
              : ui::button(answer.label.c_str(), answer.hint.c_str()))
      taken = &answer;
    if (first && ImGui::IsWindowAppearing()) {  // Enter selects the default
      ImGui::SetItemDefaultFocus();
      ui::lead_by_keyboard();
    }
  }
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) && question.answers.back().label == "Cancel")
    taken = &question.answers.back();
  if (taken) {
    const auto then = taken->then;
    questions_.pop_front();
    ImGui::CloseCurrentPopup();
    if (then) then();
  }
  ImGui::EndPopup();
}

void App::draw_opening() {
  const std::optional<Jobs::Progress> opening = editor.jobs.progress(Files::kOpenJob);
  const bool shown = opening && opening->seconds > kLongOpening && questions_.empty() && !after_leaving_;
  if (!shown && !opening_shown_) return;
  const ui::Scope scope("Opening");
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  if (shown) ImGui::OpenPopup("Opening");
  ImGui::SetNextWindowPos({0.5f * size.x, 0.4f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  opening_shown_ = ImGui::BeginPopupModal(
      "Opening", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove);
  if (!opening_shown_) return;
  if (shown) {
    const float wide = std::min(ui::px(420), 0.7f * size.x);
    ui::title(ui::fitted(printable(opening->what), *ui::font(ui::Type::kTitle), wide, ui::px(60)).c_str());
    ui::gap(ui::kGap);
    ImGui::ProgressBar(static_cast<float>(opening->share), {wide, ui::px(6)}, "");
    ui::dim(ui::fitted(fmt::format("{:.0f} s  {}", opening->seconds, printable(opening->doing)), *ImGui::GetFont(),
                       wide, ImGui::GetFontSize())
                .c_str());
    ui::gap(ui::kPad);
    const bool gives_up = ui::button("Cancel", "Esc", true, 110);
    if (ImGui::IsWindowAppearing()) {
      ImGui::SetItemDefaultFocus();
      ui::lead_by_keyboard();
    }
    if (gives_up || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) files_->give_up_opening();
  } else {
    opening_shown_ = false;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void App::draw_banners() {
  float y = viewport_low_.y + ui::px(ui::kPad);
  for (const auto& each : panels_) {
    if (each->place() != Panel::Place::kBanner || !each->shown(editor)) continue;
    // In a small viewport, beside the axis cross at the right.
    const bool narrow = viewport_high_.x - viewport_low_.x < ui::px(640);
    ImGui::SetNextWindowPos(
        {narrow ? viewport_low_.x + ui::px(ui::kPad) : 0.5f * (viewport_low_.x + viewport_high_.x), y},
        ImGuiCond_Always, {narrow ? 0.0f : 0.5f, 0.0f});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ui::palette().raised);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui::px(ui::kPad), ui::px(ui::kSpace)));
    ImGui::Begin(each->name(), nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    {
      const ui::Scope scope(each->name());
      each->draw(editor);
    }
    y += ImGui::GetWindowSize().y + ui::px(ui::kGap);
    ImGui::End();
  }
}

}  // namespace pliant
