// TrafficScene.h - a town with cars of which some move in each frame, made by formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/scene/View.h"

#include <memory>
#include <vector>

namespace osgRayTrace::bench
{

/// A plane with roads, blocks of houses between them and 100 cars, under the sun and the sky. All
/// lengths are in metres, +z is up.
class TrafficScene
{
public:
    static constexpr int kCars = 100;

    /// Makes a town in which so many of the cars move.
    explicit TrafficScene(int movers);

    /// Returns the town at a frame of 1/30 s. The stamps of what has not moved stay.
    std::shared_ptr<const engine::Scene> at(int frame) const;

    /// Returns whether the instance is a car that moves.
    bool moves(uint32_t instance) const;

    /// Returns the view of somebody on a roof.
    static engine::View view(int width, int height);

private:
    struct Car
    {
        uint32_t instance;
        double road;  ///< coordinate across the road
        double start; ///< coordinate along the road
        double speed; ///< metres a frame; the sign says which way
        bool alongX;
    };

    void addTown();
    void addCars(int movers);
    static engine::Affine placeOf(const Car& car, int frame);

    engine::Scene _base;
    std::vector<Car> _cars;
};

} // namespace osgRayTrace::bench
