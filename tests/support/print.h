#pragma once

#include <doctest/doctest.h>

#include <cstdio>

#include "plumb/ray.h"

// What doctest prints of a hit: the depth in hexadecimal, where the last bit shows.

template <>
struct doctest::StringMaker<plumb::Hit> {
  static String convert(const plumb::Hit& hit) {
    char text[64];
    std::snprintf(text, sizeof text, "(%a, %u)", static_cast<double>(hit.t), static_cast<unsigned>(hit.id));
    return text;
  }
};
