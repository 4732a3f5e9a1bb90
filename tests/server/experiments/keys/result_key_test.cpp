// What makes a flight or an estimator another one.
#include "server/experiments/keys/result_key.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "server/experiments/keys/program_files.hpp"
#include "server/experiments/keys/script_modules.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;

std::string flight_key_of(const std::vector<std::string>& fields) {
  return flight_key(server::testing::small_scenario(fields));
}

TEST(FlightKey, FollowsEveryFieldButNamesAndEstimators) {
  const std::string key = flight_key_of({});
  EXPECT_EQ(flight_key_of({}), key);
  EXPECT_EQ(flight_key_of({"title=\"another\"", "description=\"text\""}), key);
  EXPECT_EQ(flight_key_of({R"(estimators=[{"name":"p","type":"perfect"}])"}), key);
  for (const char* field : {"seed=77",
                            "duration_s=1.5",
                            "camera.rate_hz=20",
                            "flight.course.airspeed_m_s=17",
                            "pacing=\"real_time\""}) {
    EXPECT_NE(flight_key_of({field}), key) << field;
  }
}

TEST(FlightKey, IsTheSameForEqualNumbers) {
  EXPECT_EQ(flight_key_of({"flight.course.airspeed_m_s=17"}),
            flight_key_of({"flight.course.airspeed_m_s=17.0"}));
  const Json whole = {{"name", "a"}, {"parameters", {{"levels", 3}, {"scale", 1.25}}}};
  const Json real = {{"name", "a"}, {"parameters", {{"levels", 3.0}, {"scale", 1.25}}}};
  EXPECT_EQ(result_key("flight", whole), result_key("flight", real));
}

TEST(FlightKey, FollowsTheFilesOfAFolder) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "set" / "images");
  write_text(folder.path() / "set" / "images" / "1.png", "one");
  const auto key = [&] {
    Scenario scenario = server::testing::small_scenario({});
    scenario.resolved["camera"]["images"] = {{"source", (folder.path() / "set").string()}};
    return flight_key(scenario);
  };
  const std::string first = key();
  EXPECT_EQ(key(), first);
  write_text(folder.path() / "set" / "images" / "1.png", "other");
  const std::string changed = key();
  EXPECT_NE(changed, first);
  write_text(folder.path() / "set" / "data.csv", "list");
  EXPECT_NE(key(), changed);
}

TEST(FlightKey, FollowsTheDataOfTheWorld) {
  const TemporaryFolder folder;
  const auto key_with = [&](const std::string& elevation) {
    // The digest does not depend on whether the files are good.
    write_text(folder.path() / "elevation.tif", elevation);
    Scenario scenario = server::testing::small_scenario({});
    write_text(folder.path() / "world.json", R"({"elevation": [{"file": "elevation.tif"}]})");
    scenario.resolved["world"] = {{"manifest", (folder.path() / "world.json").string()}};
    return flight_key(scenario);
  };
  const std::string key = key_with("heights");
  EXPECT_EQ(key_with("heights"), key);
  EXPECT_NE(key_with("heightz"), key) << "of the same size";
  // Of large files the size and the time count.
  const std::string large(std::size_t{2} << 20U, 'x');
  const std::string of_large = key_with(large);
  const fs::file_time_type time = fs::last_write_time(folder.path() / "elevation.tif");
  const std::string later = key_with(large);
  fs::last_write_time(folder.path() / "elevation.tif", time + std::chrono::seconds(5));
  Scenario scenario = server::testing::small_scenario({});
  scenario.resolved["world"] = {{"manifest", (folder.path() / "world.json").string()}};
  EXPECT_NE(flight_key(scenario), of_large);
  EXPECT_NE(flight_key(scenario), later);
}

/// A scenario with layers of its own: elevation in the folder `data`, imagery of a virtual raster
/// with a source elsewhere, next to the scenario.
class LayersOfAFlight : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(root() / "data");
    fs::create_directories(root() / "tiles");
    write_text(root() / "data/elevation.tif", "heights");
    write_tile(1);
    write_text(root() / "images.vrt",
               R"(<VRTDataset rasterXSize="64" rasterYSize="64"><SRS>EPSG:32616</SRS>
<GeoTransform>582700, 10, 0, 4357300, 0, -10</GeoTransform>
<VRTRasterBand dataType="Byte" band="1"><SimpleSource>
<SourceFilename relativeToVRT="1">tiles/a.tif</SourceFilename><SourceBand>1</SourceBand>
</SimpleSource></VRTRasterBand></VRTDataset>)");
  }
  void write_tile(unsigned seed) {
    overfly::testing::GeoTiff tile;
    tile.image = overfly::testing::textured_image(64, 64, 1, seed);
    tile.left = 582700.0;
    tile.top = 4357300.0;
    tile.pixel = 10.0;
    overfly::testing::write_geotiff(root() / "tiles/a.tif", tile);
  }
  [[nodiscard]] std::string key() const {
    Json document = server::testing::small_document();
    document["data"] = "data";
    document["world"] = Json::parse(
        R"({"imagery": [{"file": "./images.vrt", "attribution": "x"}],
            "elevation": [{"file": "elevation.tif", "vertical_datum": "ellipsoid", "attribution": "x"}]})");
    const Result<Scenario> scenario = resolve_scenario(document, {}, root());
    EXPECT_TRUE(scenario.ok()) << (scenario.ok() ? "" : scenario.error().message);
    return flight_key(*scenario);
  }
  [[nodiscard]] const fs::path& root() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(LayersOfAFlight, CountWhereverTheyLie) {
  const std::string first = key();
  EXPECT_EQ(key(), first);
  write_text(root() / "data/elevation.tif", "HEIGHTS");
  const std::string other_heights = key();
  EXPECT_NE(other_heights, first) << "in the data folder";
  write_tile(2);
  const std::string other_tile = key();
  EXPECT_NE(other_tile, other_heights) << "a source of a virtual raster";
  write_text(root() / "images.vrt.aux.xml", "<PAMDataset/>");
  EXPECT_NE(key(), other_tile) << "a side-car";
}

TEST_F(LayersOfAFlight, OtherFilesOfTheDataFolderDoNotCount) {
  const std::string first = key();
  fs::create_directories(root() / "data/sweep/runs");
  write_text(root() / "data/sweep/results.jsonl", "{}");
  write_text(root() / "data/notes.txt", "of the flight");
  EXPECT_EQ(key(), first);
}

/// A mapping of CSV logs may name a data folder of its own.
TEST(FlightKey, FollowsThePiecesOfAMappingInItsDataFolder) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "logs");
  write_text(folder.path() / "logs/gps.csv", "1,2,3");
  write_text(folder.path() / "own.csv", "4,5,6");
  write_text(folder.path() / "mapping.json",
             R"({"csv_mapping_version": 1, "data": "logs",
                 "pieces": [{"file": "gps.csv"}, {"file": "./own.csv"}]})");
  const auto key = [&] {
    Scenario scenario = server::testing::small_scenario({});
    scenario.resolved["flight"] = {{"log", {{"file", (folder.path() / "mapping.json").string()}}}};
    return flight_key(scenario);
  };
  const std::string first = key();
  write_text(folder.path() / "logs/gps.csv", "1,2,4");
  const std::string changed = key();
  EXPECT_NE(changed, first);
  write_text(folder.path() / "own.csv", "4,5,7");
  EXPECT_NE(key(), changed);
}

TEST(ResultKey, FollowsFlightParametersAndFiles) {
  const TemporaryFolder folder;
  const fs::path vocabulary = folder.path() / "words.txt";
  write_text(vocabulary, "one");
  const Json estimator = {{"name", "e"},
                          {"type", "process"},
                          {"command", {"/bin/true"}},
                          {"parameters", {{"vocabulary", vocabulary.string()}}}};
  const std::string key = result_key("flight", estimator);
  EXPECT_EQ(result_key("flight", estimator), key);
  EXPECT_NE(result_key("another", estimator), key);
  Json changed = estimator;
  changed["parameters"]["preset"] = "fast";
  EXPECT_NE(result_key("flight", changed), key);
  write_text(vocabulary, "two");
  EXPECT_NE(result_key("flight", estimator), key);
}

/// A PATH of one more folder, for one test.
class PathWith {
 public:
  explicit PathWith(const fs::path& folder) : before_(std::getenv("PATH")) {
    ::setenv("PATH", (folder.string() + ":" + before_).c_str(), 1);
  }
  ~PathWith() { ::setenv("PATH", before_.c_str(), 1); }
  PathWith(const PathWith&) = delete;
  PathWith& operator=(const PathWith&) = delete;

 private:
  std::string before_;
};

TEST(ResultKey, FollowsAProgramInThePath) {
  const TemporaryFolder folder;
  const fs::path program = folder.path() / "my-odometry";
  const auto write_program = [&](const std::string& text) {
    write_text(program, text);
    fs::permissions(program, fs::perms::owner_all);
  };
  write_program("#!/bin/sh\necho 1\n");
  const PathWith path(folder.path());
  const Json estimator = {{"type", "process"}, {"command", {"my-odometry", "--fast"}}};
  EXPECT_EQ(program_files("my-odometry"), std::vector<fs::path>{program});
  const std::string key = result_key("flight", estimator);
  write_program("#!/bin/sh\necho 2\n");
  EXPECT_NE(result_key("flight", estimator), key);
  EXPECT_TRUE(program_files("no-such-program-anywhere").empty());
}

/// An estimator in Python: its script, and modules next to it.
class PythonEstimator : public ::testing::Test {
 protected:
  void SetUp() override {
    write("vo.py", "import mine.filter\n");
    write("mine/filter.py", "gain = 1\n");
  }
  void write(const fs::path& file, const std::string& text) {
    fs::create_directories((root() / file).parent_path());
    write_text(root() / file, text);
  }
  [[nodiscard]] const fs::path& root() const { return folder_.path(); }
  [[nodiscard]] fs::path script() const { return root() / "vo.py"; }
  [[nodiscard]] static std::string key_of(const std::vector<std::string>& command) {
    return result_key("flight", {{"type", "process"}, {"command", command}});
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(PythonEstimator, KeyFollowsTheModulesNextToTheScript) {
  const std::vector<std::string> command{"python3", script().string(), "--fast"};
  const std::string key = key_of(command);
  EXPECT_EQ(key_of(command), key);
  write("mine/filter.py", "gain = 2\n");
  EXPECT_NE(key_of(command), key);
  write("mine/filter.py", "gain = 1\n");
  EXPECT_EQ(key_of(command), key);
  write("mine/more.py", "");
  EXPECT_NE(key_of(command), key) << "a module of the same name elsewhere may be hidden by it";
  fs::remove(root() / "mine/more.py");
  for (const char* file : {"mine/__pycache__/filter.py", ".git/hook.py", "notes.txt"}) {
    write(file, "anything");
    EXPECT_EQ(key_of(command), key) << file;
  }
  for (const char* file : {"venv/pyvenv.cfg",
                           "venv/lib/package.py",
                           "out/sweep.json",
                           "out/a.py",
                           "flown/frames.jsonl",
                           "flown/a.py"}) {
    write(file, "anything");
  }
  EXPECT_EQ(key_of(command), key) << "installed packages, sweeps and runs do not count";
  write("models/manifest.json", "{}");
  write("models/net.py", "anything");
  EXPECT_NE(key_of(command), key);
}

TEST_F(PythonEstimator, IsFoundByItsFirstLineAndThroughLinks) {
  write("bin/vo", "#!/usr/bin/env python3\n");
  fs::permissions(root() / "bin/vo", fs::perms::owner_all);
  write("bin/helper.py", "one");
  fs::create_directories(root() / "links");
  fs::create_symlink(root() / "bin/vo", root() / "links/vo");
  const std::string linked = (root() / "links/vo").string();
  EXPECT_EQ(script_modules({linked}), std::vector<fs::path>{root() / "bin/helper.py"});
  write("bin/data", "no script");
  EXPECT_TRUE(script_modules({"/bin/true", (root() / "bin/data").string()}).empty());
}

TEST_F(PythonEstimator, FoldersOfTheSystemAreNotSearched) {
  for (const auto& entry : fs::directory_iterator("/usr/bin")) {
    std::error_code ignored;
    if (!entry.is_regular_file(ignored)) continue;
    for (const fs::path& module : script_modules({entry.path().string()})) {
      ADD_FAILURE() << entry.path() << " brings " << module;
    }
  }
  // Of the folder of temporary files only its own.
  const fs::path shared = fs::temp_directory_path() / (root().filename().string() + ".py");
  write_text(shared, "");
  const std::vector<fs::path> modules = script_modules({"python3", shared.string()});
  fs::remove(shared);
  EXPECT_NE(std::find(modules.begin(), modules.end(), shared), modules.end());
  EXPECT_EQ(std::find(modules.begin(), modules.end(), script()), modules.end());
}

TEST_F(PythonEstimator, ModulesAreLimited) {
  for (int i = 0; i < 2100; ++i) {
    write("many/" + std::to_string(i) + ".py", "");
  }
  EXPECT_EQ(script_modules({"python3", script().string()}).size(), 2000U);
}

/// Builds a program with a library next to it, as an adapter with an upstream system.
class BuiltProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("c++ --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no compiler c++";
    write_text(root() / "main.cpp", "int answer(); int main() { return answer(); }\n");
    build_library(1);
    ASSERT_TRUE(run("c++ main.cpp -o program -Wl,-rpath,'$ORIGIN/lib' -Llib -lanswer"));
  }
  void build_library(int answer) {
    fs::create_directories(root() / "lib");
    write_text(root() / "answer.cpp", "int answer() { return " + std::to_string(answer) + "; }\n");
    ASSERT_TRUE(run("c++ -shared -fPIC answer.cpp -o lib/libanswer.so"));
  }
  bool run(const std::string& command) {
    return std::system(("cd '" + root().string() + "' && " + command).c_str()) == 0;
  }
  [[nodiscard]] const fs::path& root() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(BuiltProgram, KeyFollowsTheLibraryThatItBringsAlong) {
  const fs::path program = root() / "program";
  EXPECT_EQ(program_files(program.string()),
            (std::vector<fs::path>{program, root() / "lib/libanswer.so"}));
  const Json estimator = {{"type", "process"}, {"command", {program.string()}}};
  const std::string key = result_key("flight", estimator);
  build_library(2);
  EXPECT_NE(result_key("flight", estimator), key);
  build_library(1);
  EXPECT_EQ(result_key("flight", estimator), key);
  fs::remove(root() / "lib/libanswer.so");
  EXPECT_EQ(program_files(program.string()), std::vector<fs::path>{program});
}

/// LD_LIBRARY_PATH, as long as it lives.
class LibraryPath {
 public:
  explicit LibraryPath(const fs::path& folder) {
    if (const char* const value = std::getenv("LD_LIBRARY_PATH")) before_ = value;
    ::setenv("LD_LIBRARY_PATH", folder.c_str(), 1);
  }
  ~LibraryPath() {
    if (before_) {
      ::setenv("LD_LIBRARY_PATH", before_->c_str(), 1);
    } else {
      ::unsetenv("LD_LIBRARY_PATH");
    }
  }
  LibraryPath(const LibraryPath&) = delete;
  LibraryPath& operator=(const LibraryPath&) = delete;

 private:
  std::optional<std::string> before_;
};

/// As the dynamic linker: RPATH, also that of the file that needs this one, then LD_LIBRARY_PATH,
/// then RUNPATH.
TEST_F(BuiltProgram, LibrariesAreLookedForInTheOrderOfTheDynamicLinker) {
  const fs::path program = root() / "program";
  const fs::path own = root() / "lib/libanswer.so";
  const fs::path other = root() / "other/libanswer.so";
  fs::create_directories(root() / "other");
  write_text(root() / "answer.cpp", "int answer() { return 7; }\n");
  ASSERT_TRUE(run("c++ -shared -fPIC answer.cpp -o other/libanswer.so"));
  const auto link = [&](const std::string& tags) {
    return run("c++ main.cpp -o program -Wl," + tags + ",-rpath,'$ORIGIN/lib' -Llib -lanswer");
  };
  // What the program returns shows which library the dynamic linker has loaded.
  const auto answer = [&] {
    return std::system(("'" + program.string() + "'").c_str()) >>
           8;  // NOLINT(hicpp-signed-bitwise)
  };
  const LibraryPath path(other.parent_path());
  ASSERT_TRUE(link("--enable-new-dtags"));  // RUNPATH
  EXPECT_EQ(answer(), 7);
  EXPECT_EQ(program_files(program.string()), (std::vector<fs::path>{program, other}));
  ASSERT_TRUE(link("--disable-new-dtags"));  // RPATH
  EXPECT_EQ(answer(), 1);
  EXPECT_EQ(program_files(program.string()), (std::vector<fs::path>{program, own}));
  // A library without search folders of its own, of a program with an RPATH.
  write_text(root() / "between.cpp", "int answer(); int between() { return answer(); }\n");
  ASSERT_TRUE(run("c++ -shared -fPIC between.cpp -o lib/libbetween.so -Llib -lanswer"));
  write_text(root() / "main.cpp", "int between(); int main() { return between(); }\n");
  ASSERT_TRUE(
      run("c++ main.cpp -o program -Wl,--disable-new-dtags,-rpath,'$ORIGIN/lib' -Llib "
          "-lbetween -Wl,-rpath-link,lib"));
  EXPECT_EQ(answer(), 1);
  EXPECT_EQ(program_files(program.string()),
            (std::vector<fs::path>{program, root() / "lib/libbetween.so", own}));
}

TEST_F(BuiltProgram, BrokenProgramsHaveNoLibraries) {
  const fs::path program = root() / "program";
  const std::string whole = overfly::testing::read_text(program);
  // Cut, and with each byte of the headers changed: no error, no library that is not there.
  for (std::size_t bytes = 0; bytes < 4096; bytes += 61) {
    write_text(program, whole.substr(0, bytes));
    EXPECT_LE(program_files(program.string()).size(), 2U);
  }
  for (std::size_t at = 0; at < 1200; at += 3) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0xff);
    write_text(program, changed);
    EXPECT_LE(program_files(program.string()).size(), 2U) << at;
  }
}

}  // namespace
}  // namespace overfly::server::experiments
