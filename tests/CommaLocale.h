// CommaLocale.h - a global locale that writes 1.234,5, as a German host program has it.
// SPDX-License-Identifier: MIT
#pragma once

#include <locale>
#include <string>

/// While an object of this class lives, new streams get this locale. The class defines the locale
/// itself, because a machine need not have one of this kind installed.
class CommaLocale
{
public:
    CommaLocale() : _before(std::locale::global(std::locale(std::locale::classic(), new Commas))) {}
    ~CommaLocale() { std::locale::global(_before); }
    CommaLocale(const CommaLocale&) = delete;
    CommaLocale& operator=(const CommaLocale&) = delete;

private:
    struct Commas : std::numpunct<char>
    {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };

    std::locale _before;
};
