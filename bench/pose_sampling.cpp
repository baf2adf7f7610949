#include <cstdio>
#include <glm/geometric.hpp>
#include <random>

#include "bench/support/character_clip.hpp"
#include "bench/support/ratio.hpp"
#include "server/animation/local_to_model.hpp"

using namespace tweend;
using namespace tweend::bench;
struct Character { animation::Pose pose; std::vector<animation::Affine> model; double t; };
int main() {
  for (const bool moves : {true, false}) for (std::size_t joints : {20u, 67u, 250u}) {
    CharacterClip clip(joints, 20.0, moves);
    const auto set = clip.packed();
    std::vector<Character> one(1, {clip.rest_pose(), std::vector<animation::Affine>(joints), 0.0});
    std::vector<Character> many(joints == 67 ? 1000 : 1, one[0]);
    std::vector<double> jumps;
    std::mt19937 rnd(1);
    for (int i = 0; i < 4096; ++i) jumps.push_back(20.0 * static_cast<double>(rnd()) / 4294967296.0);
    for (std::size_t i = 0; i < many.size(); ++i) many[i].t = jumps[i];
    GlmPlayer glm(clip);
    double tg = 0; std::size_t n = 0, n2=0; double t2 = 0;
    auto step = [](double& t) { t += 1.0 / 60; if (t > 20) t -= 20; return t; };
    auto both = [&](Character& c, double t) { set.sample(t, animation::Interpolation::Linear, c.pose); animation::local_to_model(clip.parents, c.pose, c.model); keep(c.model.data()); };
    auto race = measure({.items = double(joints)},
      [&] { both(one[0], step(one[0].t)); },
      [&] { both(one[0], jumps[n++ % 4096]); },
      [&] { set.sample(step(t2), animation::Interpolation::Linear, one[0].pose); keep(one[0].pose.row(animation::PoseRow::Tx).data()); },
      [&] { set.sample(jumps[n2++ % 4096], animation::Interpolation::Linear, one[0].pose); keep(one[0].pose.row(animation::PoseRow::Tx).data()); },
      [&] { animation::local_to_model(clip.parents, one[0].pose, one[0].model); keep(one[0].model.data()); },
      [&] { glm.sample(step(tg)); glm.local_to_model(); keep(glm.model_from_joint.data()); });
    std::printf("%s %zu: forward %.2f seek %.2f | sample %.2f seek %.2f l2m %.2f | glm %.2f  ratio %.2f seekratio %.2f %.2f\n", moves ? "TRS" : "R", joints, race.ns(0), race.ns(1), race.ns(2), race.ns(3), race.ns(4), race.ns(5), race.ratio(5,0), race.ratio(1,0), race.ratio(3,2));
    if (joints == 67) {
      auto r = measure({.items = 67000.0, .rounds = 21}, [&] { for (int i = 0; i < 1000; ++i) both(one[0], step(one[0].t)); }, [&] { for (auto& c : many) both(c, step(c.t)); });
      std::printf("  one %.2f  1000 %.2f ratio %.2f\n", r.ns(0), r.ns(1), r.ratio(1,0));
    }
  }
}
