// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct LensOptions {
  double focal_px = 261.25;
  int rings = 3;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("focal_px", self.focal_px, "px", "focal length");
    visitor("rings", self.rings, "1", "how many rings");
  }
};

struct DeviceOptions {
  bool verbose = false;
  std::string color = "red";
  LensOptions lens;
  LensOptions spare;
  double range_m = 1.0 / 3.0;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("verbose", self.verbose, "", "say more");
    visitor("color", self.color, "", "red or blue");
    visitor.Group("lens", self.lens);
    visitor.Group("spare", self.spare);
    visitor("range_m", self.range_m, "m", "how far to look");
  }
  std::vector<std::string> Validate() const {
    std::vector<std::string> violations;
    if (range_m <= 0) violations.push_back("range_m must be positive");
    if (lens.rings < 1) violations.push_back("lens.rings must be at least 1");
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

TEST(Options, ReadsWhatTheFileNamesAndLeavesTheRest) {
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

TEST(Options, UnknownKeyNamesLineAndNearest) {
  EXPECT_EQ(ReadError("verbose: true\nlens:\n  focal_pix: 3\n"),
            "c.yaml:3: unknown key 'lens.focal_pix', did you mean 'lens.focal_px'?");
  EXPECT_THAT(ReadError("lenz:\n  rings: 3\n"), HasSubstr("did you mean 'lens'?"));
  EXPECT_THAT(ReadError("focal_px: 3\n"), HasSubstr("did you mean 'lens.focal_px'?"));
}

TEST(Options, WrongTypeNamesFileLineKeyAndWhatWasExpected) {
  EXPECT_EQ(ReadError("\nrange_m: far\n"),
            "c.yaml:2: range_m is 'far', expected a finite number (m)");
  EXPECT_EQ(ReadError("lens:\n  rings: 2.5\n"),
            "c.yaml:2: lens.rings is '2.5', expected a whole number");
  EXPECT_EQ(ReadError("verbose: 1\n"), "c.yaml:1: verbose is '1', expected true or false");
  EXPECT_THAT(ReadError("range_m: [1, 2]\n"), HasSubstr("range_m: expected a finite number"));
  EXPECT_THAT(ReadError("lens: 3\n"), HasSubstr("expected a group"));
}

TEST(Options, ReadsNumbersAsTheyAreWritten) {
  for (const char* value : {"8.5", "+8.5", " 8.5 ", "85e-1", "008.50"}) {
    EXPECT_EQ(Read(std::string("range_m: ") + value + "\n").range_m, 8.5) << value;
  }
  EXPECT_THAT(ReadError("range_m: 8,5\n"), HasSubstr("expected a finite number (m): write 8.5"));
  EXPECT_THAT(ReadError("range_m: a,b\n"), Not(HasSubstr("write")));
}

TEST(Options, RefusesNumbersThatAreNone) {
  for (const char* value :
       {"nan", "+", "+-1", "++1", ".nan", "inf", "-inf", ".inf", "1e999", "1 2", "''", "~"}) {
    EXPECT_NE(ReadError(std::string("range_m: ") + value + "\n"), "") << value;
  }
}

TEST(Options, RefusesKeyGivenTwiceAndTextThatIsNotYaml) {
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

TEST(Options, PrintedTextReadsBackToTheSameValues) {
  DeviceOptions options;
  options.verbose = true;
  options.range_m = 0.1 + 0.2;
  options.spare.focal_px = 1e-300;
  options.lens.rings = -4;
  const std::string text = PrintOptions(options);
  EXPECT_THAT(text, HasSubstr("# [px] focal length"));
  const DeviceOptions again = Read(text);
  EXPECT_EQ(again.verbose, options.verbose);
  EXPECT_EQ(again.range_m, options.range_m);
  EXPECT_EQ(again.spare.focal_px, options.spare.focal_px);
  EXPECT_EQ(again.lens.rings, options.lens.rings);
}

TEST(Options, AllViolationsAreReportedTogether) {
  DeviceOptions options;
  EXPECT_NO_THROW(RequireValid(options));
  options.range_m = -1;
  options.lens.rings = 0;
  try {
    RequireValid(options);
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "range_m must be positive; lens.rings must be at least 1");
  }
}

TEST(Options, FileThatIsNotThereIsNamed) {
  DeviceOptions options;
  EXPECT_THROW(ReadOptions("/nowhere/c.yaml", &options), InputError);
  EXPECT_THROW(ReadOptions("/", &options), InputError);
}

}  // namespace
}  // namespace kestrel
