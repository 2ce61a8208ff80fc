// What recorded runs do over their last period, and the modes that they share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fom/levels/prepared_scene.hpp"
#include "rom/emulator/emulator.hpp"
#include "training/campaign/campaign_store.hpp"
#include "training/emulation/build_emulator.hpp"

namespace undula::training {

/// One quantity of some runs.
struct RecordedResponse {
  std::string name, unit;
  std::vector<double> places_mm;
  int phases = 0;
  Eigen::MatrixXd training, held_out; ///< [phase * places + place][run]
};

/// Mid-plane of the membrane, mm, and outflow, l/min, without runs: at every second step of the scene.
std::vector<RecordedResponse> recorded_quantities(const PreparedScene& prepared, const Scene& scene);

/// Their values over the last period of a record that holds it (check_moving_record).
std::vector<Eigen::VectorXd> recorded_values(const PreparedScene& prepared, const Scene& scene,
                                             const RunRecord& record);

/// Of the first modes of the training runs those of which leaving out runs shows that their coefficients can
/// be told from the inputs: each takes away from the differences of the runs left out. `points` of training
/// and held-out runs as the emulator's inputs. Left out, a run is missed by what the coefficients of its
/// modes are off by, and by what lies outside of the modes; the modes themselves know it.
ResponseScore fit_response(const RecordedResponse& recorded,
                           const std::vector<rom::EmulatorPoint>& training_points,
                           const std::vector<rom::EmulatorPoint>& held_out_points, rom::Emulator& emulator);

/// Both for the runs that the emulator uses of a plan. Nothing where the scene's runs hold no fields of a
/// moving domain, or where a varied key changes the mesh.
void add_responses(BuiltEmulator& built, const Scene& scene, const SamplingPlan& plan,
                   const CampaignStore& store, PhaseTimer& timer);

} // namespace undula::training
