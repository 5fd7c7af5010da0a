// PhotonOpeningsTest.cpp - photons are sent through small openings, and their mean stays the same.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/SlitRooms.h"
#include "tests/Statistics.h"

#include "osgRayTrace/film/PassSums.h"
#include "osgRayTrace/photons/OpeningFinder.h"
#include "osgRayTrace/photons/PhotonPasses.h"

#include <cmath>
#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

RenderOptions sppm(bool guided)
{
    RenderOptions options = optionsOf(IntegratorKind::Sppm);
    options.photons = 16384;
    options.photonGuiding = guided;
    return options;
}

std::vector<float> picture(const std::shared_ptr<const TracedScene>& traced, const View& view,
                           const RenderOptions& options, int threads, int passes = 8)
{
    RenderSession session(std::make_shared<Workers>(threads), std::make_shared<PhotonPasses>());
    session.setScene(traced);
    session.setOptions(options);
    session.setView(view);
    StopRule rule;
    rule.passes = passes;
    REQUIRE(session.render(rule).droppedSamples == 0);
    return session.resolveRadiance();
}

/// Returns the sums of some passes of the dark room, made by a session of their own.
PassSums sumsOf(const std::shared_ptr<const TracedScene>& traced, bool guided, int first, int end,
                int threads)
{
    RenderSession session(std::make_shared<Workers>(threads), std::make_shared<PhotonPasses>());
    session.setScene(traced);
    session.setOptions(sppm(guided));
    session.setView(viewOf(true, 32));
    session.setSums(FilmSums::Exact);
    session.setFirstPass(first);
    StopRule rule;
    rule.passes = end;
    REQUIRE(session.render(rule).status.ok());
    const std::optional<PassSums> sums = session.passSums();
    REQUIRE(sums);
    return *sums;
}

/// Holds openings of several sizes and weights, which overlap, and a point that sees them all.
struct Openings
{
    PhotonOpenings openings{{{{0.3f, 0.2f, 1.0f}, 0.4f, {0, 0, 1}, 1.0f},
                             {{-0.1f, 0.3f, 1.2f}, 0.3f, {0, 0, 1}, 0.5f},
                             {{0.9f, -0.9f, 0.5f}, 0.3f, {0, 0, 1}, 0.1f},
                             {{0.0f, 0.0f, 1.0f}, 0.5f, {0, 0, -1}, 1.0f}}, // from behind
                            2.0f};
    PhotonOpenings::Views views = {};

    explicit Openings(float power = 1.0f)
    {
        FloatLanes powers = {};
        for (int i = 0; i < kLanes; ++i)
        {
            setLane(views.normal, i, Vec3(0, 0, 1));
            powers[i] = power;
        }
        openings.look(powers, kAllLanes, views);
        REQUIRE(views.lanes == kAllLanes);
    }
};

/// Returns the density of directions through the openings, from the weight that they give.
double densityOf(const Openings& o, Vec3 wi)
{
    Vec3Lanes directions = {};
    setLane(directions, 0, wi);
    FloatLanes weights;
    o.openings.weigh(o.views, directions, FloatLanes{}, weights);
    const double pdf = double(kInvPi) * double(wi.z), weight = double(weights[0]);
    return (pdf / weight - pdf) / double(o.views.children[0]);
}

struct Numbers
{
    std::mt19937 random{7};
    float operator()() { return unitFloat(uint32_t(random())); }
};

/// weight: that of the opening that the child is sent to.
Vec3 childOf(const Openings& o, Numbers& numbers, FloatLanes& weight)
{
    FloatLanes choice = {}, u = {}, v = {};
    choice[0] = numbers();
    u[0] = numbers();
    v[0] = numbers();
    Vec3Lanes wi = {};
    o.openings.sample(o.views, choice, u, v, 1u, wi, weight);
    return laneOf(wi, 0);
}

/// Returns the powers of the photons of a pass that end in the dark room, summed up.
double darkPower(const std::shared_ptr<const TracedScene>& traced, const PhotonOpenings* openings,
                 int pass, std::vector<PhotonFlight>* flights = nullptr)
{
    const std::vector<Light>& lights = traced->scene().lights;
    const PhotonEmitter emitter(*traced, lights, 0.0f, PhotonUse::Indirect);
    PhotonPassOptions options;
    options.use = PhotonUse::Indirect;
    options.photons = 16384;
    const Workers workers(2);
    PhotonMemory memory;
    const TracedPhotons photons = tracePhotons(*traced, lights, emitter, options, pass, workers,
                                               memory, nullptr, openings, flights != nullptr);
    if (flights)
    {
        const auto before = uint32_t(flights->size());
        for (PhotonFlight flight : photons.flights)
        {
            if (flight.before != kInvalid) flight.before += before;
            flights->push_back(flight);
        }
    }
    double sum = 0.0;
    for (const Photon& photon : listOf(photons.photons.spans()))
        if (photon.position.x > 4.001f) sum += double(luminance(photon.power));
    return sum;
}

/// Returns points on the far wall of the dark room.
std::vector<SeenPoint> farWall()
{
    std::vector<SeenPoint> points;
    for (int k = 0; k < 4096; ++k)
        points.push_back({{8.0f, float(k % 64) / 16.0f, float(k / 64) * 3.0f / 64.0f}, {-1, 0, 0}});
    return points;
}

} // namespace

TEST_CASE("photon openings: the density of directions is one in all, and that of the samples",
          "[photons][statistics]")
{
    const Openings o;
    CHECK(o.views.children[0] > 0.0f);
    Numbers numbers;
    Estimate whole, bins[8];
    constexpr int kSamples = 200000;
    for (int k = 0; k < kSamples; ++k)
    {
        // Uniform in the hemisphere; the cones of the openings do not reach the horizon.
        const Vec3 wi = squareToCone({numbers(), numbers()}, 1.0f);
        const double density = 2.0 * double(kPi) * densityOf(o, wi);
        whole.add(density);
        const int bin = (wi.x > 0.3f) + 2 * (wi.y > 0.2f) + 4 * (wi.z > 0.9f);
        for (int b = 0; b < 8; ++b)
            bins[b].add(b == bin ? density : 0.0);
    }
    CAPTURE(whole.mean(), whole.standardError());
    CHECK(whole.agrees(1.0)); // false alarm: 6e-5
    CHECK(whole.standardError() < 0.01);
    double counts[8] = {};
    for (int k = 0; k < kSamples; ++k)
    {
        FloatLanes weight;
        const Vec3 wi = childOf(o, numbers, weight);
        CHECK(densityOf(o, wi) > 0.0);
        counts[(wi.x > 0.3f) + 2 * (wi.y > 0.2f) + 4 * (wi.z > 0.9f)] += 1.0;
    }
    // Chi-square of the counts beside densities that have errors themselves; seven degrees of
    // freedom at most are above 29 with a probability of 1.4e-4.
    double chiSquare = 0.0;
    for (int b = 0; b < 8; ++b)
    {
        const double share = counts[b] / kSamples, error = bins[b].standardError();
        if (share == 0.0 && bins[b].mean() == 0.0) continue;
        chiSquare += std::pow(share - bins[b].mean(), 2.0) /
                     (share * (1.0 - share) / kSamples + error * error);
    }
    CAPTURE(chiSquare);
    CHECK(chiSquare < 29.0);
}

TEST_CASE("photon openings: a photon and its children have the photon's power together",
          "[photons][statistics]")
{
    for (const float power : {0.1f, 1.0f, 100.0f})
    {
        const Openings o(power);
        Numbers numbers;
        Estimate sums, along; // of all light, and of what goes to one side
        for (int k = 0; k < 100000; ++k)
        {
            Vec3Lanes wi = {};
            FloatLanes weights;
            const Vec3 plain = squareToCosineHemisphere(numbers(), numbers());
            setLane(wi, 0, plain);
            o.openings.weigh(o.views, wi, FloatLanes{}, weights);
            double sum = double(weights[0]), side = plain.x > 0.3f ? sum : 0.0;
            if (numbers() < o.views.children[0])
            {
                FloatLanes chosen;
                const Vec3 child = childOf(o, numbers, chosen);
                setLane(wi, 0, child);
                o.openings.weigh(o.views, wi, chosen, weights);
                sum += double(weights[0]);
                side += child.x > 0.3f ? double(weights[0]) : 0.0;
            }
            sums.add(sum);
            along.add(side);
        }
        // The share of a cosine-weighted hemisphere beyond x = 0.3, as a segment of the unit disc.
        const double expected = (std::acos(0.3) - 0.3 * std::sqrt(0.91)) / double(kPi);
        CAPTURE(power, sums.mean(), sums.standardError(), along.mean(), expected);
        CHECK(sums.agrees(1.0)); // false alarms: 6e-5 each
        CHECK(along.agrees(expected));
    }
}

TEST_CASE("photon openings: a flight begins where the one before it has ended", "[photons]")
{
    const auto traced = rooms().build(2);
    const PhotonOpenings wide({{{4.0f, 2.04f, 1.5f}, 0.5f, {1, 0, 0}}}, 1e-4f);
    for (const PhotonOpenings* openings : {static_cast<const PhotonOpenings*>(nullptr), &wide})
    {
        std::vector<PhotonFlight> flights;
        darkPower(traced, openings, 3, &flights);
        darkPower(traced, openings, 4, &flights);
        std::size_t first = 0, wrong = 0;
        for (std::size_t k = 0; k < flights.size(); ++k)
        {
            const PhotonFlight& flight = flights[k];
            if (flight.before == kInvalid)
            {
                ++first;
                continue;
            }
            REQUIRE(flight.before < k);
            wrong += glm::distance(flights[flight.before].to, flight.from) > 1e-3f;
        }
        CHECK(first >= 2 * 16384);
        CHECK(first < flights.size() / 2);
        CHECK(wrong == 0);
    }
}

TEST_CASE("photon openings: a slit is found, and its light varies by half at most",
          "[photons][statistics]")
{
    const auto traced = rooms().build(2);
    std::vector<PhotonFlight> flights;
    Estimate plain, sent;
    constexpr int kPasses = 24;
    for (int pass = 0; pass < kPasses; ++pass)
        plain.add(darkPower(traced, nullptr, pass, pass < 6 ? &flights : nullptr));
    const Sphere scene{{4, 2, 1.5f}, 4.8f};
    CHECK(seenShare(scene, flights, farWall()) < 0.1);
    const auto openings = findOpenings(scene, flights, farWall(), 6 * 16384);
    REQUIRE(openings);
    int atSlit = 0;
    for (const PhotonOpening& opening : openings->openings())
        atSlit +=
            std::abs(opening.centre.x - 4.0f) < 0.3f && std::abs(opening.centre.y - 2.04f) < 0.3f;
    CAPTURE(openings->openings().size(), atSlit);
    CHECK(2 * std::size_t(atSlit) > openings->openings().size());
    for (int pass = 0; pass < kPasses; ++pass)
        sent.add(darkPower(traced, openings.get(), 1000 + pass));
    CAPTURE(plain.mean(), plain.standardError(), sent.mean(), sent.standardError());
    const double spread = std::hypot(plain.standardError(), sent.standardError());
    CHECK(std::abs(plain.mean() - sent.mean()) <= 4.0 * spread); // false alarm: 1e-4
    CHECK(sent.variance() < 0.5 * plain.variance());

    // Photons that these openings have sent find smaller ones, which hold all of the slit.
    std::vector<PhotonFlight> sentFlights;
    for (int pass = 0; pass < 6; ++pass)
        darkPower(traced, openings.get(), 2000 + pass, &sentFlights);
    const auto refined = refineOpenings(scene, sentFlights, farWall(), 6 * 16384, openings);
    REQUIRE(refined != openings);
    float inside = 0.0f, weights = 0.0f;
    for (const PhotonOpening& opening : refined->openings())
    {
        CHECK(opening.weight <= 1.0f);
        weights += opening.weight;
        if (std::abs(opening.centre.x - 4.0f) < 0.1f && std::abs(opening.centre.y - 2.04f) < 0.1f)
            inside += opening.weight;
    }
    CAPTURE(refined->openings().size(), inside, weights);
    CHECK(inside > 0.8f * weights);
    Estimate fine;
    for (int pass = 0; pass < kPasses; ++pass)
        fine.add(darkPower(traced, refined.get(), 3000 + pass));
    CAPTURE(fine.mean(), fine.standardError(), fine.variance() / plain.variance());
    const double fineSpread = std::hypot(plain.standardError(), fine.standardError());
    CHECK(std::abs(plain.mean() - fine.mean()) <= 4.0 * fineSpread); // false alarm: 1e-4
    CHECK(fine.variance() < 0.1 * plain.variance());
}

TEST_CASE("photon openings: none where the view shows the lit room, or the opening is wide",
          "[photons]")
{
    // Pictures are the same bit by bit as without guiding.
    for (const bool wide : {false, true})
    {
        const auto traced = rooms(wide ? 2.0f : kSlit).build(2);
        const View view = viewOf(wide, 32);
        CHECK(picture(traced, view, sppm(true), 2) == picture(traced, view, sppm(false), 2));
    }
}

TEST_CASE(
    "photon openings: passes that replace the first ones are the same in sessions of their own",
    "[photons]")
{
    const auto traced = rooms().build(2);
    const PassSums whole = sumsOf(traced, true, 0, 9, 1);
    PassSums parts = sumsOf(traced, true, 6, 9, 2);
    addSums(sumsOf(traced, true, 0, 3, 2), parts);
    addSums(sumsOf(traced, true, 3, 6, 1), parts);
    CHECK(parts.passes == whole.passes);
    CHECK(parts.low == whole.low);
    CHECK(parts.high == whole.high);
    CHECK(sumsOf(traced, false, 0, 9, 2).low != whole.low);
}

TEST_CASE("photon openings: equal for any number of threads, and the mean that of passes without",
          "[photons][statistics]")
{
    const auto traced = rooms().build(2);
    const View view = viewOf(true, 32);
    const std::vector<float> one = picture(traced, view, sppm(true), 1);
    CHECK(one == picture(traced, view, sppm(true), 2));
    CHECK(one == picture(traced, view, sppm(true), 16));
    CHECK(one != picture(traced, view, sppm(false), 2));

    // Pixels whose radius is set take discs in all passes; others choose anew once there are
    // openings.
    for (const float radius : {0.2f, 0.0f})
    {
        Estimate means[2];
        for (const bool guided : {false, true})
            for (uint32_t seed = 0; seed < 12; ++seed)
            {
                RenderOptions options = sppm(guided);
                options.photonRadius = radius;
                options.seed = seed + 100 * guided;
                const std::vector<float> rgba = picture(traced, view, options, 2, 8);
                double sum = 0.0;
                for (std::size_t k = 0; k < rgba.size(); k += 4)
                    sum += double(rgba[k]);
                means[guided].add(sum);
            }
        const double spread = std::hypot(means[0].standardError(), means[1].standardError());
        CAPTURE(radius, means[0].mean(), means[0].standardError(), means[1].mean(),
                means[1].standardError());
        CHECK(std::abs(means[0].mean() - means[1].mean()) <= 4.0 * spread); // false alarm: 1e-3
    }
}
