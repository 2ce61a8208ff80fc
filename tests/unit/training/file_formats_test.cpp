// Files of the versions of every format, as the program of their time wrote them (tests/data/formats): those
// that are still read hold the numbers that were written, the others and those of a later version are
// refused. Those of a new version:
//   test_unit_training --gtest_also_run_disabled_tests
//   --gtest_filter=FileFormats.DISABLED_WritesTheFilesOfThisVersion
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "fom/output/checkpoint.hpp"
#include "fom/output/field_writer.hpp"
#include "rom/base/file_format.hpp"
#include "rom/emulator/emulator.hpp"
#include "rom/fixed_domain/model.hpp"
#include "rom/moving_domain/moving_model.hpp"
#include "tests/unit/rom/synthetic_operators.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/campaign/run_record_file.hpp"
#include "training/study/study_store.hpp"
#include "training/training.hpp"

namespace undula::training {
namespace {

namespace fs = std::filesystem;

const fs::path shipped = fs::path(UNDULA_SOURCE_DIR) / "tests/data/formats";
const SceneStamp stamp{"0123456789abcdef", "name = \"flap\"\n"};
const std::vector<double> study_values{0.5, 2};

/// A copy of the shipped files, which stores may lock and clean up.
class FileFormats : public testing::Test {
protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("undula_formats_" + std::to_string(::getpid()));
    fs::remove_all(folder);
    fs::copy(shipped, folder, fs::copy_options::recursive);
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder;
};

std::string message_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

rom::Model sample_model() {
  rom::Model model;
  model.operators = rom::synthetic_operators({3, 1, 1}, 1.0);
  model.operators.supremizer_modes = 1;
  model.operators.linear(0, 1) = -0.125;
  model.steps_per_period = 96;
  model.box = {80, 140, 0.1, 0.8, 0, 70};
  model.references = {{120, 0.53, 40, 3.25, 1e-4, true, 3.26, 0.01, 0.02, 512.5},
                      {80, 0.1, 0, 0.5, 0, false, 0.03, 0.1, 0.2, 99}};
  model.error_safety = 1.25;
  model.error_floor_l_per_min = 0.01;
  model.provenance = {{"scene", "name = \"pump\"\n"}, {"commit", "0123abc"}};
  return model;
}

void expect_the_sample(const rom::Model& model) {
  EXPECT_EQ(model.operators.velocity_modes, 3);
  EXPECT_EQ(model.operators.supremizer_modes, 1);
  EXPECT_EQ(model.operators.linear(0, 1), -0.125);
  EXPECT_EQ(model.steps_per_period, 96);
  EXPECT_EQ(model.box.head_high_mmHg, 70);
  ASSERT_EQ(model.references.size(), 2u);
  EXPECT_TRUE(model.references[0].held_out);
  EXPECT_EQ(model.references[1].flow_l_per_min, 0.5);
  EXPECT_EQ(model.error_safety, 1.25);
  EXPECT_EQ(model.provenance.at("commit"), "0123abc");
}

rom::Emulator sample_emulator() {
  rom::Emulator emulator;
  emulator.driven_by_voltage = true;
  emulator.inputs = {
      rom::EmulatorInput{"frequency", "Hz", 120, 120}, {"voltage", "V", 30, 50}, {"head", "mmHg", 20, 60}};
  const Eigen::MatrixXd points = (Eigen::MatrixXd(2, 4) << 0, 1, 0, 1, 0, 0, 1, 1).finished();
  emulator.quantities.push_back({"flow_l_per_min",
                                 "l/min",
                                 {points,
                                  Eigen::Vector4d(5, 6, 1, 2),
                                  Eigen::VectorXd::Constant(4, 0.01),
                                  {Eigen::Vector2d(1, 1), 0.2, 1e-4}},
                                 1.7});
  emulator.runs = {{{120, 30, 20}, 5, 0.02, false, 5.1, 0.1, 300},
                   {{120, 45, 30}, 6, 0, true, 6.1, 0.2, 200}};
  emulator.provenance = {{"commit", "0123abc"}};
  return emulator;
}

/// A modulus that no run varied, and a course over four phases.
rom::Emulator emulator_with_further_inputs() {
  auto emulator = sample_emulator();
  emulator.force_N_per_V = 0.4;
  emulator.inputs.push_back({"membrane.young_dyn_per_cm2", "dyn_per_cm2", 1.5e7, 1.5e7, 1.5e7});
  for (auto& run : emulator.runs) run.point.push_back(1.5e7);
  rom::EmulatedResponse outflow{"outflow_l_per_min",         "l/min", {0}, 4,
                                Eigen::Vector4d(1, 2, 3, 2), {},      {},  0.3};
  outflow.modes = Eigen::Vector4d(0.5, -0.5, 0.5, -0.5);
  outflow.coefficients.push_back(emulator.quantities[0].process);
  emulator.responses.push_back(std::move(outflow));
  return emulator;
}

rom::MovingModel sample_moving_model() {
  rom::MovingModel model;
  model.scene = "name = \"pump\"\n";
  model.basis = (Eigen::MatrixXd(3, 2) << 1, 0, 0, -0.5, 0, 2).finished();
  model.pressure_modes = 1;
  model.box = {100, 140, 34, 50, 20, 75};
  rom::MovingRun run;
  run.frequency_Hz = 120;
  run.voltage_V = 40;
  run.head_mmHg = 50;
  run.flow_l_per_min = 1.9;
  model.runs = {run};
  model.error_l_per_min = 0.1;
  return model;
}

RunRecord sample_record() {
  RunRecord record;
  record.point.frequency = 120;
  record.point.stroke = 0.053;
  record.point.head = 66000;
  record.state = RunState::periodic;
  record.times = {0.5, 0.75};
  record.snapshots["velocity"] = {"cm/s", (Eigen::MatrixXd(3, 2) << 1, 2, 3, 4, 5, 6).finished()};
  record.cycles.columns = {"flow"};
  record.cycles.periods = {1, 2};
  record.cycles.mean = {3, 4};
  record.cycles.minimum = {2, 3};
  record.cycles.maximum = {4, 5};
  record.seconds = {{"solve", 1.5}};
  return record;
}

RunRecord varied_record() {
  auto record = sample_record();
  record.point.varied["membrane.young_dyn_per_cm2"] = 1.5e7;
  return record;
}

const FieldMesh<2> triangle{{Point<2>(0, 0), Point<2>(1, 0), Point<2>(0, 1)}, {{0, 1, 2}}};

TEST_F(FileFormats, DISABLED_WritesTheFilesOfThisVersion) {
  rom::save_model(sample_model(), (shipped / "reduced_model_2.h5").string());
  rom::save_emulator(emulator_with_further_inputs(), (shipped / "emulator_2.h5").string());
  rom::save_moving_model(sample_moving_model(), (shipped / "moving_model_1.h5").string());
  Checkpoint checkpoint;
  checkpoint.step = 7;
  checkpoint.time = 0.25;
  checkpoint.scalars["holder"] = 0.5;
  checkpoint.arrays["velocity"] = {1, -2, 3};
  checkpoint.scene = stamp;
  save_checkpoint(checkpoint, shipped / "checkpoint_2");
  write_run_record(varied_record(), stamp.hash, shipped / "run_record_3.h5");
  CampaignStore(shipped / "campaign_3", stamp);
  const StudyStore study(shipped / "study_1", stamp);
  const auto claim = study.try_claim(study_values);
  study.store(claim.value(), {study_values, "periodic", "", {{"flow_l_per_min", 1.5}}, 2.5});
  auto fields = FieldWriter<2>::start(shipped / "fields_1", "fluid", triangle, {});
  fields.write(1, 0.5, std::vector<NodalField>{{"pressure", "dyn/cm^2", 1, {1, 2, 3}}});
  fields.sync();
}

TEST_F(FileFormats, ModelsOfEveryVersionAreRead) {
  const auto first = rom::load_model((folder / "reduced_model_1.h5").string());
  expect_the_sample(first);
  EXPECT_FALSE(first.sealed);
  const auto second = rom::load_model((folder / "reduced_model_2.h5").string());
  expect_the_sample(second);
  EXPECT_TRUE(second.sealed);

  const auto emulator = rom::load_emulator((folder / "emulator_1.h5").string());
  EXPECT_TRUE(emulator.driven_by_voltage);
  EXPECT_EQ(emulator.inputs[1].high, 50);
  ASSERT_EQ(emulator.quantities.size(), 1u);
  EXPECT_EQ(emulator.quantities[0].process.values()[2], 1);
  ASSERT_EQ(emulator.runs.size(), 2u);
  EXPECT_EQ(emulator.runs[1].flow_l_per_min, 6);
  const auto further = rom::load_emulator((folder / "emulator_2.h5").string());
  EXPECT_EQ(further.force_N_per_V, 0.4);
  ASSERT_EQ(further.inputs.size(), 4u);
  EXPECT_EQ(further.inputs[3].stated, 1.5e7);
  EXPECT_EQ(further.runs[1].point.back(), 1.5e7);
  ASSERT_EQ(further.responses.size(), 1u);
  EXPECT_EQ(further.responses[0].mean[1], 2);
  EXPECT_EQ(further.responses[0].coefficients.size(), 1u);

  const auto moving = rom::load_moving_model((folder / "moving_model_1.h5").string());
  EXPECT_EQ(moving.basis(1, 1), -0.5);
  EXPECT_EQ(moving.box.stroke_high_mm, 50);
  ASSERT_EQ(moving.runs.size(), 1u);
  EXPECT_EQ(moving.runs[0].flow_l_per_min, 1.9);
}

TEST_F(FileFormats, StatesAndRecordsOfThisVersionAreRead) {
  const auto checkpoint = load_checkpoint(folder / "checkpoint_2/checkpoint_7.h5", stamp);
  EXPECT_EQ(checkpoint.time, 0.25);
  EXPECT_EQ(checkpoint.scalars.at("holder"), 0.5);
  EXPECT_EQ(checkpoint.arrays.at("velocity"), (std::vector<double>{1, -2, 3}));

  const auto record = read_run_record(folder / "run_record_2.h5", stamp.hash, sample_record().point);
  EXPECT_EQ(record.snapshots.at("velocity").values(2, 1), 6);
  EXPECT_EQ(record.cycles.mean, (std::vector<double>{3, 4}));
  EXPECT_TRUE(record.point.varied.empty());
  const auto varied = read_run_record(folder / "run_record_3.h5", stamp.hash, varied_record().point);
  EXPECT_EQ(varied.point.varied, varied_record().point.varied);
  EXPECT_NO_THROW(CampaignStore(folder / "campaign_3", stamp));
  EXPECT_NO_THROW(CampaignStore(folder / "campaign_2", stamp));

  const auto run = StudyStore(folder / "study_1", stamp).load(study_values);
  EXPECT_EQ(run.state, "periodic");
  ASSERT_EQ(run.quantities.size(), 1u);
  EXPECT_EQ(run.quantities[0].value, 1.5);

  EXPECT_NO_THROW(FieldWriter<2>::go_on(folder / "fields_1", "fluid", triangle, {}, 1));
  EXPECT_EQ(Hdf5File::open_read(folder / "fields_1/fluid_1.h5").read<double>("fields/pressure"),
            (std::vector<double>{1, 2, 3}));
}

TEST_F(FileFormats, StatesAndRecordsWithoutASealAreRefused) {
  for (const auto& message :
       {message_of([&] { load_checkpoint(folder / "checkpoint_1/checkpoint_7.h5", stamp); }),
        message_of([&] { read_run_record(folder / "run_record_1.h5", stamp.hash, sample_record().point); })})
    EXPECT_NE(message.find("of an older version"), std::string::npos) << message;
}

/// One kind of file: what a version to come would write, and who reads it.
struct Kind {
  FileFormat format; ///< as it is today
  bool model;        ///< states its kind as models do
  const char* file;
  std::function<void(const fs::path& folder)> read;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {{"undula reduced model", "", 2},
       true,
       "model.h5",
       [](const fs::path& at) { rom::load_model((at / "model.h5").string()); }},
      {{"undula emulator", "", 2},
       true,
       "model.h5",
       [](const fs::path& at) { rom::load_emulator((at / "model.h5").string()); }},
      {{"undula moving-domain model", "", 1},
       true,
       "model.h5",
       [](const fs::path& at) { rom::load_moving_model((at / "model.h5").string()); }},
      {{"undula checkpoint", "", 2},
       false,
       "checkpoint_7.h5",
       [](const fs::path& at) { load_checkpoint(at / "checkpoint_7.h5", stamp); }},
      {{"undula run record", "", 3},
       false,
       "record.h5",
       [](const fs::path& at) { read_run_record(at / "record.h5", stamp.hash, sample_record().point); }},
      {{"undula campaign", "", 3},
       false,
       "campaign.h5",
       [](const fs::path& at) { CampaignStore(at, stamp); }},
      {{"undula study", "", 1}, false, "study.h5", [](const fs::path& at) { StudyStore(at, stamp); }},
      {{"undula fields", "", 1}, false, "fluid_1.h5", [](const fs::path& at) {
         FieldWriter<2>::go_on(at, "fluid", triangle, {}, 1);
       }}};
  return all;
}

/// A file of the version after this one. What else it holds, nobody knows yet.
void write_later(const fs::path& file, const Kind& kind) {
  FileFormat later = kind.format;
  ++later.version;
  auto written = Hdf5File::create(file);
  if (kind.model)
    write_format_version(written, later);
  else
    written.write_attribute("/", "format", format_text(later));
  written.commit();
}

TEST_F(FileFormats, ThoseOfALaterVersionAreRefusedInFourParts) {
  for (const Kind& kind : kinds()) {
    const auto at = folder / "later" / kind.format.kind;
    fs::create_directories(at);
    write_later(at / kind.file, kind);
    const auto message = message_of([&] { kind.read(at); });
    const std::string later =
        std::string(kind.format.kind) + ", format " + std::to_string(kind.format.version + 1);
    for (const std::string& part :
         {std::string("written by a later version of Undula"), "\n  seen:    " + later,
          std::string("\n  allowed: format "), "\n  where:   " + at.string()})
      EXPECT_NE(message.find(part), std::string::npos) << kind.format.kind << ": " << message;
  }
}

// A record of this version that cannot be read counts as damaged and is computed again. One of a later
// version is whole.
TEST_F(FileFormats, RecordsOfALaterVersionAreNotTakenForDamagedOnes) {
  const auto point = sample_record().point;
  const CampaignStore campaign(folder / "campaign_2", stamp);
  write_later(campaign.record_file(point), kinds()[4]);
  EXPECT_THROW(campaign.status(std::vector{point}), LaterFormatError);
  EXPECT_THROW(campaign.try_claim(point), LaterFormatError);
  std::vector<std::string> damaged;
  EXPECT_THROW(campaign.recorded_points(damaged), LaterFormatError);

  const StudyStore study(folder / "study_1", stamp);
  for (const auto& entry : fs::directory_iterator(folder / "study_1"))
    if (entry.path().extension() == ".h5" && entry.path().filename() != "study.h5")
      write_later(entry.path(), {{"undula study record", "", 1}, false, "", {}});
  EXPECT_THROW(study.try_claim(study_values), LaterFormatError);
}

} // namespace
} // namespace undula::training
