#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "prediction/comparison/features.hpp"
#include "samples/graph_sample.hpp"

namespace clearway::training {

/// Points that move on a line of 1 km with their own speeds; each is dark with probability 0.4 for some
/// seconds, and is then believed where its old speed would have brought it, though its true speed changed.
/// Features as the schema `corrected` has them.
class SyntheticRun {
  public:
    explicit SyntheticRun(std::uint32_t seed) : random_(seed) {}

    samples::GraphSampleFile file(std::uint32_t replication, int samples, const char* failure = "B10") {
        samples::GraphSampleFile file;
        file.origin = {"line", failure, prediction::corrected_schema(), 1, replication, 50.0};
        for (int second = 0; second < samples; ++second)
            file.samples.push_back(sample(second));
        return file;
    }

  private:
    struct Point {
        float true_x, believed_x, age;
    };

    samples::GraphSample sample(double time_s) {
        samples::GraphSample sample;
        sample.time_s = time_s;
        sample.vehicle_count = 25;
        std::vector<Point> points;
        for (std::uint32_t row = 0; row < sample.vehicle_count; ++row)
            points.push_back(point());
        for (const Point& point : points) {
            constexpr float k = 2.0F * std::numbers::pi_v<float> / prediction::corrected_wavelength_m;
            constexpr float amplitude = prediction::corrected_amplitude;
            sample.features.insert(sample.features.end(), {amplitude * std::cos(k * point.believed_x),
                                                           amplitude * std::sin(k * point.believed_x),
                                                           amplitude, 0.0F, std::exp(-point.age / 10.0F)});
        }
        for (std::uint32_t left = 0; left < sample.vehicle_count; ++left) {
            for (std::uint32_t right = left + 1; right < sample.vehicle_count; ++right) {
                add_pair(points, left, right, sample);
            }
        }
        return sample;
    }

    Point point() {
        const float true_x = 1000.0F * uniform_(random_);
        if (uniform_(random_) > 0.4F) return {true_x, true_x, 0.0F};
        const float age = 1.0F + 14.0F * uniform_(random_);
        return {true_x, true_x + age * 4.0F * (uniform_(random_) - 0.5F), age};
    }

    static void add_pair(const std::vector<Point>& points, std::uint32_t left, std::uint32_t right,
                         samples::GraphSample& sample) {
        const float believed = std::abs(points[left].believed_x - points[right].believed_x);
        const bool linked = std::abs(points[left].true_x - points[right].true_x) < 50.0F;
        if (points[left].age == 0.0F && points[right].age == 0.0F) {
            if (linked) sample.observed_edges.push_back({left, right});
        } else if (believed < 120.0F) {
            sample.candidates.push_back({left, right, believed, static_cast<std::uint8_t>(linked)});
        }
    }

    std::mt19937 random_;
    std::uniform_real_distribution<float> uniform_{0.0F, 1.0F};
};

inline std::vector<samples::GraphSampleFile> synthetic_files(std::uint32_t seeds, int samples_each) {
    std::vector<samples::GraphSampleFile> files;
    for (std::uint32_t replication = 0; replication < seeds; ++replication) {
        files.push_back(SyntheticRun(100 + replication).file(replication, samples_each));
    }
    return files;
}

}  // namespace clearway::training
