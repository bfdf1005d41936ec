// The scenes in which `python3 -m clearway.conformance` judges predictors in Python.

#include "prediction/darkness.hpp"
#include "prediction/python_predictor.hpp"
#include "python/part_scenes.hpp"

namespace clearway::prediction {
namespace {

constexpr const char* busy = R"(
    10 m per cell, limit 20 m/s, speed 15 m/s
    a.h.a.hh.a..e.h.a.a.+hh.a..h.e.a.h..........................
    .h.a.ha.e.h..a.h.h.a+.a..h.a.hh.a...........................
)";

class PythonScenes : public ::testing::Test {
  protected:
    /// The scene when all report, then three times `age_s` later, when the named ones went dark.
    void show(const char* name, const char* drawing, double age_s, std::initializer_list<const char*> dark) {
        support::Scene scene(drawing);
        const auto recorder =
            make_python_predictor({scene.network(), {}, {}}, scenes.recorder(), scenes.settings(name));
        traffic::BelievedGraph belief;
        recorder->predict(support::perfect_observation(scene), belief);
        for (int decision = 0; decision < 3; ++decision)
            recorder->predict(testing::after_outage(scene, age_s, dark), belief);
    }

    clearway::testing::PartScenes scenes;
};

TEST_F(PythonScenes, are_those_of_the_package) {
    show("two vehicles, one dark", testing::side_by_side, 2.0, {"a1"});
    show("many vehicles, some dark for a second", busy, 1.0, {"a1", "a3", "h2", "h5", "e1"});
    show("many vehicles, most dark for 6 s", busy, 6.0,
         {"a1", "a2", "a3", "a4", "a5", "a6", "a7", "h1", "h2", "h3", "h4", "h5", "h6", "h7", "h8", "e1",
          "e2"});
    show("an EV alone, dark for 25 s", "10 m per cell, limit 20 m/s\n..e......................", 25.0,
         {"e1"});
    scenes.expect_shipped("predictor_scenes.jsonl");
}

}  // namespace
}  // namespace clearway::prediction
