#include "training/campaign/campaign_store.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <random>
#include <thread>

#include "rom/base/error.hpp"
#include "training/campaign/run_record_file.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

using namespace std::chrono_literals;

const SceneStamp stamp{"0123456789abcdef-20-1-32", "[scene]\nname = \"pump\"\n"};

std::vector<OperatingPoint> plan(int count) {
  std::vector<OperatingPoint> points;
  for (int k = 0; k < count; ++k) points.push_back({80 + k / 3.0, 0.053, 1333.22387415 * k});
  return points;
}

/// Every number follows from the point, so that a mixed-up or half-written record shows.
RunRecord record_of(const OperatingPoint& point, int unknowns = 7) {
  RunRecord record;
  record.point = point;
  record.state = RunState::periodic;
  record.times = {0.1, 0.2, 0.30000000000000004};
  for (const std::string name : {"velocity", "pressure"}) {
    auto& field = record.snapshots[name];
    field.unit = name == "velocity" ? "cm/s" : "dyn/cm^2";
    field.values.resize(unknowns, 3);
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < unknowns; ++i)
        field.values(i, j) = point.frequency * i + point.head / (j + 1) + 0.1;
  }
  record.cycles = {{"outflow_l_per_min", "power_W"}, {1, 2}, {1, 2, 3, 4}, {0, 1, 2, 3}, {2, 3, 4, 5}};
  record.seconds = {{"solve", 1.5}, {"total", 2.5}};
  return record;
}

class CampaignStoreTest : public testing::Test {
protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::temp_directory_path() /
             ("undula_campaign_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
    std::filesystem::remove_all(folder);
  }
  void TearDown() override {
    std::filesystem::remove_all(folder);
    std::filesystem::remove(folder.string() + ".log");
  }

  int files_ending(const std::string& end) const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      count += entry.path().filename().string().ends_with(end);
    return count;
  }

  /// Works through the plan as a training process does; one line per computed point goes to `log`.
  void work(const std::vector<OperatingPoint>& points, int unknowns,
            std::chrono::microseconds run_time) const {
    const CampaignStore store(folder, stamp);
    std::ofstream log(folder.string() + ".log", std::ios::app);
    for (const auto& point : store.status(points).pending) {
      const auto claim = store.try_claim(point);
      if (!claim) continue;
      std::this_thread::sleep_for(run_time);
      store.store(*claim, record_of(point, unknowns));
      log << point.head << std::endl;
    }
  }

  /// Runs `body` in a child process; returns its pid.
  template <class Body>
  static pid_t child(Body body) {
    const pid_t pid = ::fork();
    if (pid != 0) return pid;
    int code = 0;
    try {
      body();
    } catch (const std::exception& error) {
      std::fputs(error.what(), stderr);
      code = 1;
    }
    ::_exit(code); // none of the parent's exit handlers (MPI)
  }

  static int status_of(pid_t pid) {
    int status = 0;
    ::waitpid(pid, &status, 0);
    return status;
  }

  std::filesystem::path folder;
};

TEST_F(CampaignStoreTest, RecordsComeBackBitForBit) {
  const auto points = plan(3);
  const CampaignStore store(folder, stamp);
  auto written = record_of(points[1]);
  written.state = RunState::not_periodic;
  written.reason = "means of the last periods differ by 3 %";
  store.store(*store.try_claim(points[1]), written);
  const auto read = store.load(points[1]);
  EXPECT_EQ(read.point.frequency, points[1].frequency);
  EXPECT_EQ(read.state, RunState::not_periodic);
  EXPECT_EQ(read.reason, written.reason);
  EXPECT_EQ(read.times, written.times);
  ASSERT_EQ(read.snapshots.size(), 2u);
  EXPECT_EQ(read.snapshots.at("velocity").values, written.snapshots.at("velocity").values);
  EXPECT_EQ(read.snapshots.at("pressure").unit, "dyn/cm^2");
  EXPECT_EQ(read.cycles.columns, written.cycles.columns);
  EXPECT_EQ(read.cycles.periods, written.cycles.periods);
  EXPECT_EQ(read.cycles.maximum, written.cycles.maximum);
  EXPECT_EQ(read.seconds, written.seconds);
}

TEST_F(CampaignStoreTest, VariedKeysTellRecordsApart) {
  const CampaignStore store(folder, stamp);
  OperatingPoint softer = plan(2)[1];
  const OperatingPoint stated = softer;
  softer.varied = {{"membrane.young_dyn_per_cm2", 1.55e7}, {"membrane.damping_time_s", 1e-4}};
  OperatingPoint stiffer = softer;
  stiffer.varied["membrane.young_dyn_per_cm2"] = 1.9e7;
  for (const auto& point : {softer, stated}) store.store(*store.try_claim(point), record_of(point));
  EXPECT_EQ(store.load(softer).point.varied, softer.varied);
  EXPECT_TRUE(store.load(stated).point.varied.empty());
  EXPECT_EQ(store.status(std::vector{softer, stated, stiffer}).pending.size(), 1u);
  std::vector<std::string> damaged;
  const auto recorded = store.recorded_points(damaged);
  EXPECT_TRUE(damaged.empty());
  ASSERT_EQ(recorded.size(), 2u);
  EXPECT_EQ(recorded[0].varied.size() + recorded[1].varied.size(), 2u);
}

TEST_F(CampaignStoreTest, AFailedRunIsARecordToo) {
  const auto points = plan(1);
  const CampaignStore store(folder, stamp);
  RunRecord failed;
  failed.point = points[0];
  failed.state = RunState::failed;
  failed.reason = "non-finite state";
  store.store(*store.try_claim(points[0]), failed);
  EXPECT_TRUE(store.status(points).pending.empty());
  EXPECT_EQ(store.load(points[0]).state, RunState::failed);
  EXPECT_EQ(store.load(points[0]).reason, "non-finite state");
}

TEST_F(CampaignStoreTest, PendingIsThePlanWithoutTheRecords) {
  const auto points = plan(5);
  {
    const CampaignStore store(folder, stamp);
    EXPECT_EQ(store.status(points).pending.size(), 5u);
    for (const int k : {3, 0}) store.store(*store.try_claim(points[k]), record_of(points[k]));
  }
  const CampaignStore reopened(folder, stamp);
  const auto pending = reopened.status(points).pending;
  ASSERT_EQ(pending.size(), 3u);
  EXPECT_EQ(pending[0].head, points[1].head);
  EXPECT_EQ(pending[2].head, points[4].head);
  EXPECT_FALSE(reopened.try_claim(points[3]));
  EXPECT_THROW(reopened.load(points[1]), InputError);
}

TEST_F(CampaignStoreTest, APointIsClaimedOnce) {
  const auto points = plan(2);
  const CampaignStore store(folder, stamp), other(folder, stamp);
  {
    const auto claim = store.try_claim(points[0]);
    ASSERT_TRUE(claim);
    EXPECT_FALSE(other.try_claim(points[0]));
    EXPECT_TRUE(other.try_claim(points[1]));
    EXPECT_THROW(store.store(*claim, record_of(points[1])), InputError);
  }
  EXPECT_TRUE(other.try_claim(points[0])); // given back without a record
}

TEST_F(CampaignStoreTest, RefusesAnotherCampaignAndForeignFolders) {
  { const CampaignStore store(folder, stamp); }
  const SceneStamp changed{"fedcba9876543210-20-1-32", stamp.text};
  try {
    const CampaignStore store(folder, changed);
    FAIL() << "opened with another hash";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(stamp.hash), std::string::npos) << message;
    EXPECT_NE(message.find(changed.hash), std::string::npos) << message;
  }
  const auto foreign = folder / "somebody_elses";
  std::filesystem::create_directory(foreign);
  std::ofstream(foreign / "thesis.tex") << "precious";
  EXPECT_THROW(CampaignStore(foreign, stamp), InputError);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(foreign), {}), 1);
  std::ofstream(folder / "campaign.h5") << "broken";
  EXPECT_THROW(CampaignStore(folder, stamp), InputError);
}

TEST_F(CampaignStoreTest, DamagedRecordsAreReportedAndComputedAgain) {
  const auto points = plan(3);
  const CampaignStore store(folder, stamp);
  for (const auto& point : points) store.store(*store.try_claim(point), record_of(point));
  const auto truncated = store.record_file(points[0]);
  std::filesystem::resize_file(truncated, std::filesystem::file_size(truncated) - 1);
  write_run_record(record_of(points[2]), "another hash", store.record_file(points[2]));
  const auto status = store.status(points);
  ASSERT_EQ(status.pending.size(), 2u);
  ASSERT_EQ(status.damaged.size(), 2u);
  EXPECT_NE(status.damaged[0].find(truncated.filename().string()), std::string::npos) << status.damaged[0];
  EXPECT_NE(status.damaged[1].find("another hash"), std::string::npos) << status.damaged[1];
  store.store(*store.try_claim(points[0]), record_of(points[0]));
  EXPECT_EQ(store.load(points[0]).times, record_of(points[0]).times);
}

TEST_F(CampaignStoreTest, RefusesRecordsThatDoNotFitTogether) {
  const auto points = plan(1);
  const CampaignStore store(folder, stamp);
  const auto claim = store.try_claim(points[0]);
  auto record = record_of(points[0]);
  record.times.pop_back();
  EXPECT_THROW(store.store(*claim, record), InputError);
  record = record_of(points[0]);
  record.cycles.mean.pop_back();
  EXPECT_THROW(store.store(*claim, record), InputError);
  EXPECT_EQ(store.status(points).pending.size(), 1u);
}

TEST_F(CampaignStoreTest, CleansUpOnlyWhatNobodyIsWriting) {
  const auto points = plan(2);
  const CampaignStore store(folder, stamp);
  const auto claim = store.try_claim(points[0]);
  for (const auto& point : points)
    std::ofstream(store.record_file(point).string() + ".99.0.partial") << "half";
  const CampaignStore reopened(folder, stamp);
  EXPECT_TRUE(std::filesystem::exists(store.record_file(points[0]).string() + ".99.0.partial"));
  EXPECT_FALSE(std::filesystem::exists(store.record_file(points[1]).string() + ".99.0.partial"));
}

TEST_F(CampaignStoreTest, SurvivesKillsAtAnyMoment) {
  const auto points = plan(24);
  const int unknowns = 20000; // about a megabyte, so that kills meet half-written files
  const auto begin = std::chrono::steady_clock::now();
  work(std::vector{points[0]}, unknowns, 0us);
  const std::chrono::duration<double, std::micro> one_record = std::chrono::steady_clock::now() - begin;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  double verifying_us = 0; // of all records there are, which every process does first
  int kills = 0, interrupted_writes = 0;
  std::size_t before = points.size() - 1;
  while (kills < 400) {
    const pid_t pid = child([&] { work(points, unknowns, 0us); });
    std::this_thread::sleep_for(std::chrono::duration<double, std::micro>(
        part(random) * (3 * one_record.count() + 2 * verifying_us)));
    ::kill(pid, SIGKILL);
    const int status = status_of(pid);
    ASSERT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) != 0);
    kills += WIFSIGNALED(status);
    interrupted_writes += files_ending(".partial") > 0;
    const CampaignStore store(folder, stamp);
    EXPECT_EQ(files_ending(".partial"), 0);
    const auto before_status = std::chrono::steady_clock::now();
    const auto now = store.status(points);
    verifying_us =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - before_status).count();
    EXPECT_TRUE(now.damaged.empty()) << now.damaged.front();
    EXPECT_LE(now.pending.size(), before); // nothing done is ever lost
    before = now.pending.size();
    if (before == 0) break;
  }
  RecordProperty("kills", kills);
  RecordProperty("interrupted_writes", interrupted_writes);
  EXPECT_EQ(before, 0u) << "no progress in " << kills << " kills";
  EXPECT_GT(interrupted_writes, 0) << "no kill met a write: the test proves too little";
  const CampaignStore store(folder, stamp);
  for (const auto& point : points) {
    const auto read = store.load(point);
    EXPECT_EQ(read.snapshots.at("velocity").values,
              record_of(point, unknowns).snapshots.at("velocity").values);
  }
}

TEST_F(CampaignStoreTest, ProcessesShareThePlanAndComputeNothingTwice) {
  const auto points = plan(30);
  { const CampaignStore store(folder, stamp); }
  std::vector<pid_t> workers;
  for (int k = 0; k < 4; ++k) workers.push_back(child([&] { work(points, 50, 3ms); }));
  for (const pid_t pid : workers) EXPECT_EQ(status_of(pid), 0);
  const CampaignStore store(folder, stamp);
  EXPECT_TRUE(store.status(points).pending.empty());
  std::ifstream log(folder.string() + ".log");
  int computed = 0;
  for (std::string line; std::getline(log, line);) ++computed;
  EXPECT_EQ(computed, 30);
}

TEST_F(CampaignStoreTest, AFolderOfVersion2GoesOnAsWhatItIs) {
  Scene scene;
  scene.name = "pump";
  scene.training.sampled_periods = 1;
  scene.training.frequency_low = 80;
  const auto point = plan(1)[0];
  {
    const RecordStore before(folder, {"campaign", {"undula campaign", "a campaign", 2}, {}},
                             stamp_campaign_of_version_2(scene));
    write_run_record(
        record_of(point), before.hash(),
        folder / CampaignStore(CampaignStore::of_scene(folder, scene)).record_file(point).filename());
  }
  EXPECT_TRUE(CampaignStore::of_scene(folder, scene).status(std::vector{point}).pending.empty());
  scene.training.frequency_low = 70; // of that version another campaign
  EXPECT_THROW(CampaignStore::of_scene(folder, scene), InputError);
  std::filesystem::remove_all(folder);
  {
    const auto now = CampaignStore::of_scene(folder, scene);
    now.store(*now.try_claim(point), record_of(point));
  }
  scene.training.frequency_low = 60;
  EXPECT_TRUE(CampaignStore::of_scene(folder, scene).status(std::vector{point}).pending.empty());
}

TEST(CampaignStamp, DependsOnWhatShapesTheRecordsOnly) {
  Scene scene;
  scene.name = "pump";
  scene.training.sampled_periods = 1;
  const auto hash = stamp_campaign(scene).hash;
  auto other = scene;
  other.operating_point.frequency = 99;
  other.training.training_points = 50;
  EXPECT_EQ(stamp_campaign(other).hash, hash);
  other.training.frequency_low = 80; // a wider box goes on with the runs
  other.training.head_low = 1000;
  other.training.voltage_low = 12;
  EXPECT_EQ(stamp_campaign(other).hash, hash);
  EXPECT_NE(stamp_campaign_of_version_2(other).hash, stamp_campaign_of_version_2(scene).hash);
  other = scene;
  other.training.sampled_periods = 2;
  EXPECT_NE(stamp_campaign(other).hash, hash);
  other = scene;
  other.fluid.density = 1.05;
  EXPECT_NE(stamp_campaign(other).hash, hash);
}

} // namespace
} // namespace undula::training
