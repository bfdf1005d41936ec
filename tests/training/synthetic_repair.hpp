#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "samples/repair_sample.hpp"

namespace clearway::training {

/// Samples of the improved net's form that could be real: vehicles on a straight road of 600 m, a third of
/// them not known. A hidden vehicle's true displacement is half of what the rule says when its speed feature
/// is below 0.5 and all of it otherwise, so that there is something to learn that the rule does not know.
class SyntheticRepair {
  public:
    explicit SyntheticRepair(std::uint32_t seed, float radius_m = 50.0F)
        : random_(seed), radius_m_(radius_m) {}

    samples::RepairSampleFile file(std::uint32_t replication, int samples, const char* failure = "B10") {
        samples::RepairSampleFile file;
        file.origin = {"line", failure, prediction::repair_schema(), 1, replication, radius_m_};
        for (int second = 0; second < samples; ++second)
            file.samples.push_back(sample(second));
        return file;
    }

    samples::RepairSample sample(double time_s) {
        constexpr std::uint32_t rows = 24;
        samples::RepairSample sample;
        sample.time_s = time_s;
        prediction::RepairInputs& inputs = sample.inputs;
        inputs.rows = rows;
        inputs.radius_m = radius_m_;
        inputs.nodes.assign(rows * prediction::node_width, 0.0F);
        std::vector<float> true_x_m(rows);
        for (std::uint32_t row = 0; row < rows; ++row) {
            const float x_m = 600.0F * uniform();
            const float speed = uniform();
            inputs.x_m.push_back(x_m);
            inputs.y_m.push_back(0.0F);
            inputs.place_sigma_m.push_back(0.7F * static_cast<float>(row % 4));
            float* const numbers = &inputs.nodes[row * prediction::node_width];
            const bool known = row % 3 != 0;
            numbers[prediction::node_input("known")] = known ? 1.0F : 0.0F;
            numbers[prediction::node_input("speed")] = speed;
            true_x_m[row] = x_m;
            if (known) continue;
            prediction::Receiver receiver;
            receiver.row = row;
            receiver.reach_m = 150.0F;
            receiver.displacement_m = 140.0F * uniform();
            const float true_displacement_m = receiver.displacement_m * (speed < 0.5F ? 0.5F : 1.0F);
            sample.true_displacement_m.push_back(true_displacement_m);
            for (std::size_t i = 0; i < prediction::path_points; ++i) {
                receiver.path.points[i] = {x_m + 10.0F * static_cast<float>(i), 0.0F};
            }
            for (std::size_t number = prediction::common_width; number < prediction::node_width; ++number)
                numbers[number] = uniform() - 0.5F;
            numbers[prediction::node_input("displacement")] = receiver.displacement_m / 100.0F;
            true_x_m[row] = x_m + true_displacement_m;
            inputs.receivers.push_back(receiver);
            add_edges(row, inputs);
        }
        for (std::uint32_t left = 0; left < rows; ++left) {
            for (std::uint32_t right = left + 1; right < rows; ++right) {
                if (left % 3 != 0 && right % 3 != 0) continue;
                add_pair({left, right}, true_x_m, sample);
            }
        }
        return sample;
    }

  private:
    void add_edges(std::uint32_t row, prediction::RepairInputs& inputs) {
        for (std::uint32_t source = 0; source < inputs.rows; source += 5) {
            if (source == row) continue;
            inputs.source.push_back(source);
            for (std::uint32_t number = 0; number < prediction::edge_width; ++number)
                inputs.edges.push_back(uniform() < 0.3F ? 0.0F : uniform() - 0.5F);
        }
        inputs.first_edge.push_back(static_cast<std::uint32_t>(inputs.source.size()));
    }

    static float rule_x_m(const prediction::RepairInputs& inputs, std::uint32_t row) {
        for (const prediction::Receiver& receiver : inputs.receivers) {
            if (receiver.row == row) return inputs.x_m[row] + receiver.displacement_m;
        }
        return inputs.x_m[row];
    }

    void add_pair(prediction::RowPair pair, const std::vector<float>& true_x_m,
                  samples::RepairSample& sample) {
        const float distance_m =
            std::abs(rule_x_m(sample.inputs, pair.left) - rule_x_m(sample.inputs, pair.right));
        sample.inputs.pairs.push_back(pair);
        for (std::uint32_t number = 0; number < prediction::pair_width; ++number) {
            sample.inputs.pair_features.push_back(number < 3 ? std::min(distance_m / 50.0F, 4.0F)
                                                             : uniform() - 0.5F);
        }
        const float apart_m = std::abs(true_x_m[pair.left] - true_x_m[pair.right]);
        sample.linked.push_back(apart_m < radius_m_ ? 1 : 0);
        sample.rule.push_back(1.0F / (1.0F + std::exp((distance_m - radius_m_) / 10.0F)));
    }

    float uniform() { return std::uniform_real_distribution<float>(0.0F, 1.0F)(random_); }

    std::mt19937 random_;
    float radius_m_;
};

/// Runs with two failures in turn.
inline std::vector<samples::RepairSampleFile> runs(std::uint32_t count, int samples = 12) {
    SyntheticRepair world(3);
    std::vector<samples::RepairSampleFile> files;
    for (std::uint32_t replication = 0; replication < count; ++replication)
        files.push_back(world.file(replication, samples, replication % 2 == 0 ? "B10" : "A.5"));
    return files;
}

}  // namespace clearway::training
