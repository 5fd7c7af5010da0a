// PValuesTest.cpp - the tests' own tail probabilities, compared with tables and by simulation.
// SPDX-License-Identifier: MIT
#include "tests/PValues.h"
#include "tests/Catch.h"

using namespace osgRayTrace::engine::test;

TEST_CASE("p-values: Student's t as in the tables", "[statistics]")
{
    CHECK(studentTail(12.706, 1.0) == Approx(0.05).epsilon(1e-4));
    CHECK(studentTail(1.0, 1.0) == Approx(0.5).epsilon(1e-9));
    CHECK(studentTail(2.228, 10.0) == Approx(0.05).epsilon(1e-3));
    CHECK(studentTail(3.646, 30.0) == Approx(0.001).epsilon(1e-3));
    CHECK(studentTail(3.0, 1e6) == Approx(normalTail(3.0)).epsilon(1e-4));
    CHECK(studentTail(0.0, 5.0) == Approx(1.0));
}

TEST_CASE("p-values: Kolmogorov's distance as in the tables", "[statistics]")
{
    // The values are 100 even values pushed together to a distance of 0.134: 5 % for n = 100.
    std::vector<double> values;
    for (int i = 0; i < 100; ++i)
        values.push_back((i + 0.5) / 100.0);
    CHECK(kolmogorovSmirnovTest(values) == Approx(1.0));
    for (double& value : values)
        value = std::max(value - 0.129, 0.0);
    CHECK(kolmogorovSmirnovTest(values) == Approx(0.05).margin(0.005));
}

TEST_CASE("p-values: of equal means they are uniform, of others small", "[statistics]")
{
    // There are 4000 comparisons of 12 and 20 values of different spread, with 1 % false alarms.
    Uniform random(7);
    const auto normal = [&]
    {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i)
            sum += double(random());
        return sum;
    };
    const auto compare = [&](double shift)
    {
        Estimate a, b;
        for (int i = 0; i < 12; ++i)
            a.add(5.0 + normal());
        for (int i = 0; i < 20; ++i)
            b.add(5.0 + shift + 3.0 * normal());
        return welchTest(a, 12, b, 20, 0.0);
    };
    std::vector<double> equal, shifted;
    for (int i = 0; i < 4000; ++i)
    {
        equal.push_back(compare(0.0));
        shifted.push_back(compare(0.5));
    }
    CHECK(kolmogorovSmirnovTest(equal) > 0.01);
    CHECK(kolmogorovSmirnovTest(shifted) < 1e-6);
}
