// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/options.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

struct LensOptions {
  double focal_px = 261.25;
  int rings = 3;

  static void Visit(auto& self, auto&& visit) {
    visit("focal_px", self.focal_px, "focal length");
    visit("rings", self.rings, AtLeast(1), "[rings] how many there are");
    visit.Gone({"half_angle_deg", "coating"});
  }
};

struct DeviceOptions {
  bool verbose = false;
  std::string color = "red";
  LensOptions lens;
  LensOptions spare;
  double range_m = 1.0 / 3.0;

  static void Visit(auto& self, auto&& visit) {
    visit("verbose", self.verbose, "say more");
    visit("color", self.color, OneOf{{"red", "blue"}}, "colour of the case");
    visit.Group("lens", self.lens);
    visit.Group("spare", self.spare);
    visit("range_m", self.range_m, Range{0, 30, false}, "how far to look");
  }
  std::vector<std::string> Validate() const {
    std::vector<std::string> violations;
    if (lens.rings > spare.rings) violations.push_back("lens has more rings than spare");
    return violations;
  }
};

DeviceOptions Read(const std::string& yaml) {
  DeviceOptions options;
  ReadOptionFields(yaml, "c.yaml", FieldsOf(options));
  return options;
}

std::string ReadError(const std::string& yaml) {
  try {
    Read(yaml);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, ReadsGivenKeysAndKeepsOtherValues) {
  const DeviceOptions options = Read("verbose: true\nspare:\n  rings: 7\n  focal_px: 1e2\n");
  EXPECT_TRUE(options.verbose);
  EXPECT_EQ(options.spare.rings, 7);
  EXPECT_EQ(options.spare.focal_px, 100);
  EXPECT_EQ(options.lens.rings, 3);
  EXPECT_EQ(options.lens.focal_px, 261.25);
}

TEST(Options, EmptyFileAndEmptyGroupSetNothing) {
  EXPECT_EQ(Read("").lens.rings, 3);
  EXPECT_EQ(Read("# nothing\nlens:\n").lens.rings, 3);
}

TEST(Options, UnknownKeyErrorNamesLineAndNearestKey) {
  EXPECT_EQ(ReadError("verbose: true\nlens:\n  focal_pix: 3\n"),
            "c.yaml:3: unknown key 'lens.focal_pix', did you mean 'lens.focal_px'?");
  EXPECT_THAT(ReadError("lenz:\n  rings: 3\n"), HasSubstr("did you mean 'lens'?"));
  EXPECT_THAT(ReadError("focal_px: 3\n"), HasSubstr("did you mean 'lens.focal_px'?"));
}

TEST(Options, WrongTypeErrorNamesFileLineKeyAndExpectation) {
  EXPECT_EQ(ReadError("\nrange_m: far\n"),
            "c.yaml:2: range_m is 'far', expected a finite number (m)");
  EXPECT_EQ(ReadError("lens:\n  rings: 2.5\n"),
            "c.yaml:2: lens.rings is '2.5', expected a whole number (rings)");
  EXPECT_EQ(ReadError("verbose: 1\n"), "c.yaml:1: verbose is '1', expected true or false");
  EXPECT_THAT(ReadError("range_m: [1, 2]\n"), HasSubstr("range_m: expected a finite number"));
  EXPECT_THAT(ReadError("lens: 3\n"), HasSubstr("expected a group"));
}

TEST(Options, ReadsNumbersInAnyNotation) {
  for (const char* value : {"8.5", "+8.5", " 8.5 ", "85e-1", "008.50"}) {
    EXPECT_EQ(Read(std::string("range_m: ") + value + "\n").range_m, 8.5) << value;
  }
  EXPECT_THAT(ReadError("range_m: 8,5\n"), HasSubstr("expected a finite number (m): write 8.5"));
  EXPECT_THAT(ReadError("range_m: a,b\n"), Not(HasSubstr("write")));
}

TEST(Options, RefusesMalformedNumbers) {
  for (const char* value :
       {"nan", "+", "+-1", "++1", ".nan", "inf", "-inf", ".inf", "1e999", "1 2", "''", "~"}) {
    EXPECT_NE(ReadError(std::string("range_m: ") + value + "\n"), "") << value;
  }
}

TEST(Options, RefusesDuplicateKeyAndNonYaml) {
  EXPECT_THAT(ReadError("range_m: 1\nrange_m: 2\n"), HasSubstr("c.yaml:2: range_m is given twice"));
  EXPECT_THAT(ReadError("lens: {rings: 1\n"), HasSubstr("not YAML"));
  EXPECT_THAT(ReadError("- 1\n- 2\n"), HasSubstr("expected 'name: value'"));
}

TEST(Options, SetsOneField) {
  DeviceOptions options;
  SetOption("lens.rings=12", &options);
  EXPECT_EQ(options.lens.rings, 12);
  EXPECT_THROW(SetOption("lens.rings", &options), InputError);
  EXPECT_THROW(SetOption("lens.rings=many", &options), InputError);
  EXPECT_THROW(SetOption("lens=3", &options), InputError);
  EXPECT_THROW(SetOption("lens.ring=3", &options), InputError);
}

TEST(Options, PrintedTextRoundTrips) {
  DeviceOptions options;
  options.verbose = true;
  options.range_m = 0.1 + 0.2;
  options.spare.focal_px = 1e-300;
  options.lens.rings = -4;
  const std::string text = PrintOptions(options);
  EXPECT_THAT(text, HasSubstr("# [px] focal length\n"));
  EXPECT_THAT(text, HasSubstr("# [rings] how many there are (1 or more)\n"));
  EXPECT_THAT(text, HasSubstr("# colour of the case (red or blue)\n"));
  EXPECT_THAT(text, HasSubstr("# [m] how far to look (more than 0 to 30)\n"));
  const DeviceOptions again = Read(text);
  EXPECT_EQ(again.verbose, options.verbose);
  EXPECT_EQ(again.range_m, options.range_m);
  EXPECT_EQ(again.spare.focal_px, options.spare.focal_px);
  EXPECT_EQ(again.lens.rings, options.lens.rings);
}

TEST(Options, ReportsAllViolationsTogether) {
  DeviceOptions options;
  EXPECT_NO_THROW(RequireValid(options));
  options.color = "green";
  options.range_m = -1;
  options.lens.rings = 0;
  try {
    RequireValid(options);
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "color is 'green', expected red or blue; lens.rings is 0, expected 1 or more; "
                 "range_m is -1, expected more than 0 to 30");
  }
}

TEST(Options, ComparesFieldsWithinTheirLimits) {
  DeviceOptions options;
  options.lens.rings = 4;
  EXPECT_THAT(ViolationsOf(options), ElementsAre("lens has more rings than spare"));
  options.spare.rings = 0;
  EXPECT_THAT(ViolationsOf(options), ElementsAre("spare.rings is 0, expected 1 or more"));
}

TEST(Options, RejectsNanAndInfinity) {
  DeviceOptions options;
  options.lens.focal_px = std::numeric_limits<double>::quiet_NaN();
  options.range_m = std::numeric_limits<double>::infinity();
  EXPECT_THAT(ViolationsOf(options), ElementsAre("lens.focal_px is nan, expected a finite number",
                                                 "range_m is inf, expected more than 0 to 30"));
}

TEST(Options, ReportsAllKeysOfFormerVersionsTogether) {
  EXPECT_EQ(ReadError("lens:\n  half_angle_deg: 90\n  rings: 4\nspare:\n  coating:\n    blue: 1\n"),
            "c.yaml: lens.half_angle_deg, spare.coating: no option any more, remove it "
            "(docs/versions.md has what holds instead)");
  DeviceOptions options;
  EXPECT_THROW(SetOption("lens.half_angle_deg=90", &options), InputError);
}

TEST(Options, ReportsMissingFile) {
  DeviceOptions options;
  EXPECT_THROW(ReadOptions("/nowhere/c.yaml", &options), InputError);
  EXPECT_THROW(ReadOptions("/", &options), InputError);
}

}  // namespace
}  // namespace kestrel
