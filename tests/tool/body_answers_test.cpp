// How a pressed finger answers to its contacts and to its own shaking, against the same written out at full length.
#include "systems/tool/reduce/body_answers.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/tool/press_scene.h"

namespace pliant {
namespace {

constexpr double kAnswerStep = 1.0 / 60;  // [s]

double distance(const Eigen::MatrixXd& x, const Eigen::MatrixXd& truth) {
  return (x - truth).norm() / truth.norm();
}

TEST(BodyAnswers, AreThoseOfTheTissueToItsContactsAndShakesAndTheGramMatrixIsTheirs) {
  for (const Attachment attachment : {Attachment::kSlave, Attachment::kSpring}) {
    Handle6 handle = firm_handle();
    handle.attachment = attachment;
    PressScene scene(firm_tissue(), handle, 0.4);
    for (int i = 1; i <= 8; ++i)
      scene.step(kAnswerStep, moved(scene.start(), join({1e-4 * i, -2e-4 * i, 0}, {0, 0, 0.01 * i}))), scene.advance();
    scene.step(kAnswerStep, moved(scene.start(), join({1e-3, -2e-3, 0}, {0, 0, 0.09})));
    const SoftBodyState& tool = scene.tool();
    const FinishedStep step{scene.bodies,  scene.contacts, scene.delassus,
                            scene.problem, kAnswerStep,    kUndonePenetration};
    const ToolContacts contacts(step, 0);
    const BodyAnswers of = answers_of(contacts, 0);
    const Eigen::Index tissue = tool.size() - 6, rows = of.contact_rows(), columns = rows + of.shaken.cols();
    ASSERT_GT(rows, 6);
    ASSERT_EQ(of.shaken.cols(), 6 * kShakes);
    ASSERT_FALSE(std::is_sorted(scene.contacts.begin(), scene.contacts.end(),
                                [](const ContactPoint& a, const ContactPoint& b) { return a.gap < b.gap; }))
        << "the chosen contacts stand in another order than the step's";

    std::vector<int> all(static_cast<std::size_t>(columns)), some{static_cast<int>(columns) - 1, 4, 0};
    std::iota(all.begin(), all.end(), 0);
    const Rows answers = answers_to(contacts, of, all), few = answers_to(contacts, of, some);
    for (std::size_t k = 0; k < some.size(); ++k)
      EXPECT_EQ(few.col(static_cast<Eigen::Index>(k)), answers.col(some[k])) << "column " << some[k] << " by itself";

    Rows pulls = Rows::Zero(tool.size(), columns);
    for (int i = 0; i < contacts.count(); ++i) tool.spread(contacts[i].a, contacts[i].axes, 1.0, pulls, 3 * i);
    pulls.rightCols(of.shaken.cols()) = of.shaken;
    Rows expected = pulls.topRows(tissue);
    tool.solve_held(expected);
    EXPECT_LT(distance(answers.topRows(tissue), expected), 1e-12);
    EXPECT_LT(answers.bottomRows<6>().cwiseAbs().maxCoeff(), 1e-12 * answers.cwiseAbs().maxCoeff());

    const Eigen::MatrixXd gram = pulls.transpose() * answers;
    EXPECT_LT(distance(of.gram, gram), 1e-12);
    EXPECT_EQ(of.gram, of.gram.transpose());
    Eigen::MatrixXd gathered(columns, columns);
    gather_rows(contacts, of, answers, gathered);
    EXPECT_LT(distance(of.gram, gathered), 1e-12);
  }
}

TEST(ToolContacts, LeaveOutAnOpenContactThatNothingCouldBePredictedOf) {
  PressScene scene(firm_tissue(), firm_handle(), 0.4);
  for (int i = 1; i <= 8; ++i)
    scene.step(kAnswerStep, moved(scene.start(), join({1e-4 * i, -2e-4 * i, 0}, {0, 0, 0.01 * i}))), scene.advance();
  scene.step(kAnswerStep, moved(scene.start(), join({1e-3, -2e-3, 0}, {0, 0, 0.09})));
  const FinishedStep step{scene.bodies, scene.contacts, scene.delassus, scene.problem, kAnswerStep, kUndonePenetration};
  const auto chosen = [&](std::size_t contact) {
    const std::vector<int> of = contacts_of(step, 0, kMaxCondensed);
    return std::find(of.begin(), of.end(), static_cast<int>(contact)) != of.end();
  };
  std::size_t pushing = 0, open = 0;
  for (std::size_t i = 0; i < scene.contacts.size(); ++i) {
    ContactPoint& c = scene.contacts[i];
    if (i % 2 == 0) c.impulse = dvec3(0.0), c.depth = 0.0;
    c.predicted = true;
    pushing += c.impulse.x > 0.0;
    open += c.impulse.x == 0.0 && c.depth == 0.0;
    ASSERT_TRUE(chosen(i));
    c.predicted = false;  // its plane is at its features' positions
    EXPECT_EQ(chosen(i), c.impulse.x > 0.0 || c.depth > 0.0) << "contact " << i;
  }
  EXPECT_GT(pushing, 0u);
  EXPECT_GT(open, 0u);
}

}  // namespace
}  // namespace pliant
