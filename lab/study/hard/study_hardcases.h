// Judges the hard cases (hard/hard_case.h) one after the other: a table of verdicts and figures.
#pragma once

#include <string>
#include <vector>

#include "lab/files/output_folder.h"
#include "lab/study/hard/hard_case.h"

namespace pliant {

struct JudgedCase {
  HardCase hard;
  HardFigure figure;
  HardVerdict verdict() const { return verdict_of(hard, figure); }
};

const char* name_of(HardVerdict verdict);  // yes, no, not judged
// "ASliverDisturbsNobody" as "a sliver disturbs nobody".
std::string words_of(const std::string& name);
std::string to_csv(const std::vector<JudgedCase>& cases);
// Two sentences: which cases hold and fail, and which is nearest to its bound.
std::vector<std::string> sentences_of(const std::vector<JudgedCase>& cases);

// Writes hardcases.svg and hardcases.png: each figure as a share of its bound.
Status plot_hardcases(OutputFolder& out, const std::vector<JudgedCase>& cases,
                      const std::vector<std::string>& sentences);

}  // namespace pliant
