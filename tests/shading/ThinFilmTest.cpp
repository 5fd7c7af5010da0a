// ThinFilmTest.cpp - the colours of thin films beside sums over wavelengths. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/ThinFilm.h"

#include <cmath>
#include <complex>

using namespace osgRayTrace::engine;

namespace
{

/// Returns the eye's response to a wavelength [nm] [Wyman13, listing 1].
Vec3d responseOf(double wavelength)
{
    const auto lobe = [wavelength](double height, double place, double below, double above)
    {
        const double t = (wavelength - place) * (wavelength < place ? below : above);
        return height * std::exp(-0.5 * t * t);
    };
    return {lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) +
                lobe(-0.065, 501.1, 0.0490, 0.0382),
            lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
            lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725)};
}

/// Returns the reflectance of a film at one wavelength, all orders of interference, by amplitudes
/// whose squares are the reflectances of the two faces.
double airy(double r12, double r23, bool turned, double way, double wavelength)
{
    using Complex = std::complex<double>;
    // A face with a lower index in front of it turns the phase.
    const Complex first = -std::sqrt(r12), back = std::sqrt(r12);
    const Complex second = std::sqrt(r23) * (turned ? 1.0 : -1.0);
    const Complex round = second * std::exp(Complex(0.0, 2.0 * M_PI * way / wavelength));
    return std::norm(first + (1.0 - r12) * round / (1.0 - back * round));
}

/// Returns the linear RGB of a film over a base of one index; what does not depend on the
/// wavelength stands beside the sum, as a white light is white.
Vec3d spectral(double cosTheta, double ior, double thickness, double base)
{
    const double cosFilm = std::sqrt(1.0 - (1.0 - cosTheta * cosTheta) / (ior * ior));
    const double r12 = fresnelDielectric(float(cosTheta), float(ior));
    const double normal = std::pow((base - ior) / (base + ior), 2);
    const double r23 = normal + (1.0 - normal) * std::pow(1.0 - cosFilm, 5);
    const double mean = r12 + (1.0 - r12) * (1.0 - r12) * r23 / (1.0 - r12 * r23);
    Vec3d xyz(0.0);
    double white = 0.0;
    for (double wavelength = 360.0; wavelength <= 830.0; wavelength += 1.0)
    {
        const Vec3d response = responseOf(wavelength);
        const double way = 2.0 * ior * thickness * cosFilm;
        xyz += response * (airy(r12, r23, base < ior, way, wavelength) - mean);
        white += response.y;
    }
    xyz /= white;
    return Vec3d(mean) + Vec3d(3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
                               -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
                               0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z);
}

Vec3 normalReflectanceOf(double index)
{
    const auto root = static_cast<float>((index - 1.0) / (index + 1.0));
    return Vec3(root * root);
}

} // namespace

TEST_CASE("thin film: the colours are those of the sum over wavelengths", "[shading]")
{
    double largest = 0.0;
    for (const double ior : {1.3, 1.8})
        for (const double base : {1.5, 2.4})
            for (const double thickness : {150.0, 250.0, 400.0, 700.0})
                for (const double cosTheta : {1.0, 0.7, 0.3})
                {
                    const Vec3d exact = spectral(cosTheta, ior, thickness, base);
                    const Vec3 film = filmReflectance(
                        float(cosTheta), {float(ior), float(thickness)}, normalReflectanceOf(base));
                    CAPTURE(ior, base, thickness, cosTheta, exact.x, exact.y, exact.z, film.x,
                            film.y, film.z);
                    for (int c = 0; c < 3; ++c)
                    {
                        // What no display can show is cut off.
                        const double error = std::abs(film[c] - glm::clamp(exact[c], 0.0, 1.0));
                        largest = std::max(largest, error);
                        CHECK(error < 0.03);
                    }
                }
    CHECK(largest > 1e-4); // the sums are not the same
}

TEST_CASE("thin film: none is left as it gets thin, and no light is made", "[shading]")
{
    const Vec3 base(0.04f, 0.5f, 0.9f);
    for (int i = 0; i <= 50; ++i)
    {
        const float cosTheta = static_cast<float>(i) / 50.0f;
        const Vec3 bare = fresnelSchlick(cosTheta, base, 1.0f);
        CHECK(glm::length(filmReflectance(cosTheta, {1.8f, 0.01f}, base) - bare) < 2e-3f);
        for (const float thickness : {20.0f, 200.0f, 2000.0f, 1e30f})
        {
            const Vec3 film = filmReflectance(cosTheta, {2.5f, thickness}, base);
            CHECK(isFinite(film));
            CHECK(film == glm::clamp(film, 0.0f, 1.0f));
        }
    }
    CHECK(filmReflectance(0.0f, {1.3f, 300.0f}, base) == Vec3(1.0f));
}
