// Tables of measured presses: which files `pliant fit` reads, and what it says of the others.
#include <gmock/gmock.h>

#include "lab/files/csv.h"
#include "lab/fit/fit_record.h"

namespace pliant {
namespace {

using ::testing::HasSubstr;

TEST(FitRecord, ColumnsAreReadByNameAndUnitAndWhatIsWrongIsSaidInASentence) {
  const auto said = [](const std::string& text) {
    const auto record = parse_press(text, "d.csv");
    return record ? std::string() : record.error().message();
  };
  std::string rows;
  for (int i = 1; i <= 9; ++i) rows += std::to_string(i) + ";" + std::to_string(2 * i) + "\n";
  const auto good = parse_press("Indentation [mm];Load (mN)\r\n" + rows, "d.csv");
  ASSERT_TRUE(good.ok()) << good.error().message();
  EXPECT_DOUBLE_EQ(good->depth[3], 0.004);
  EXPECT_DOUBLE_EQ(good->force[3], 0.008);
  EXPECT_THAT(said("depth,force_N\n1,1\n"), HasSubstr("column 'depth' does not say its unit; write depth_mm"));
  EXPECT_THAT(said("depth_ft,force_N\n1,1\n"), HasSubstr("has the unit 'ft'; must be one of m, cm, mm"));
  EXPECT_THAT(said("depth_mm\n1\n"), HasSubstr("has no column of force"));
  EXPECT_THAT(said("depth_mm,force_N\n1,nan\n"), HasSubstr("d.csv:2: its force is 'nan', which is no finite number"));
  EXPECT_THAT(said("depth_mm,force_N\n1\n"), HasSubstr("d.csv:2: has 1 cells where the header has 2"));
  EXPECT_THAT(said("depth_mm,force_N\n1,1\n"), HasSubstr("has 1 rows; a fit takes at least 8"));
  EXPECT_THAT(said("time_s,depth_mm,force_N\n0,1,1\n0,2,2\n"), HasSubstr("d.csv:3: its time does not grow"));
  EXPECT_THAT(said(""), HasSubstr("is empty"));
}

TEST(FitRecord, TablesAsProgramsWriteThemAreRead) {
  const auto read = [](const std::string& head, const std::string& row) {
    std::string text = head + "\n";
    for (int i = 1; i <= 9; ++i) {
      std::string line = row;
      while (line.find('#') != std::string::npos) line.replace(line.find('#'), 1, std::to_string(i));
      text += line + "\r\n";
    }
    const auto record = parse_press(text, "d.csv");
    EXPECT_TRUE(record.ok()) << head << ": " << (record ? "" : record.error().message());
    if (record) {
      EXPECT_DOUBLE_EQ(record->depth[3], 0.0045) << head;
      EXPECT_DOUBLE_EQ(record->force[3], 1.4) << head;
    }
    return record ? record->notes : std::vector<std::string>();
  };
  // Separators at the end of rows, of the header, or of both.
  read("depth_mm,force_N", "#.5,1.#,");
  read("depth_mm,force_N,", "#.5,1.#");
  read("depth_mm;force_N;;", "#.5;1.#;;");
  read("depth_mm\tforce_N\t", "#.5\t1.#\t");
  // Decimal commas if commas do not separate cells.
  read("depth_mm;force_N", "#,5;1,#");
  read("depth_mm\tforce_N", "#,5\t+1,#");
  // Commas and quotes in names and texts.
  read("\"note, any\";depth_mm;force (N)", "x;#,5;1,#");
  read("note,depth_mm,force_N", "\"a \"\"soft\"\", wet pad\",#.5,1.#");
  read("note,depth_mm,force_N", "\"\"\"\",#.5,\"1.#\"");
  // Other quantities with such a name are ignored.
  EXPECT_THAT(
      read("f_Hz,load_cell,depth_mm,force_N", "1,2,#.5,1.#"),
      ::testing::ElementsAre(HasSubstr("'f_Hz' is not read: 'Hz' is no unit of force"), HasSubstr("'load_cell'")));
  EXPECT_THAT(read("t_degC,depth_mm,d,force_N", "1,#.5,0,1.#"), ::testing::SizeIs(2));
  const auto said = [](const std::string& text) {
    const auto record = parse_press(text, "d.csv");
    return record ? std::string() : record.error().message();
  };
  EXPECT_THAT(said("depth_mm,force_N\n1,5,2,5\n"), HasSubstr("where its commas are decimal, put semicolons"));
  EXPECT_THAT(said("depth_mm;force_N\n1.234,5;1\n"),
              HasSubstr("'1.234,5', which is no finite number (a decimal comma"));
  EXPECT_THAT(said("depth_mm,load_cell\n1,1\n"), HasSubstr("column 'load_cell' has the unit 'cell'; must be one of N"));
  EXPECT_THAT(said("depth_mm,force_N,time_days\n1,1\n"), HasSubstr("column 'time_days' has the unit 'days'"));
  EXPECT_THAT(said("depth_mm,force_N\n1,\n"), HasSubstr("its force is ''"));
}

TEST(FitRecord, WhatCsvTextWritesIsReadBack) {
  std::vector<std::string> cells;
  for (const char* name : {"tip", "a,b", "\"", "\"\"", "\",\"", "a \"soft\", wet pad", ",", "\",", " x", ""}) {
    csv_cells(csv_text(name) + ",1," + csv_text(name), ',', cells);
    ASSERT_EQ(cells.size(), 3u) << name;
    EXPECT_EQ(cells[0], name);
    EXPECT_EQ(cells[2], name);
  }
  csv_cells("", ',', cells);
  EXPECT_EQ(cells, std::vector<std::string>{""});
  csv_cells("a,,", ',', cells);
  EXPECT_EQ(cells, (std::vector<std::string>{"a", "", ""}));
  csv_cells("\"not closed, at all", ',', cells);
  EXPECT_EQ(cells, std::vector<std::string>{"not closed, at all"});
}

TEST(FitRecord, RowsOfAToolAreRefused) {
  const std::string head = "time_s,probe,in_contact,depth_m,fx,fy,fz,fn,tx,ty,tz\n";
  std::string rows;
  for (int i = 1; i <= 9; ++i)
    rows += std::to_string(i) + ",hand,1,0.00" + std::to_string(i) + ",0,1,0,1,0,0," + (i == 9 ? "0.1" : "0") + "\n";
  const auto record = parse_press(head + rows, "forces.csv");
  ASSERT_FALSE(record.ok());
  EXPECT_THAT(record.error().message(), HasSubstr("forces.csv: `hand` is a tool"));
}

}  // namespace
}  // namespace pliant
