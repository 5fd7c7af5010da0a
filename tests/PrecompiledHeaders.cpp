// PrecompiledHeaders.cpp - a program that does nothing; the tests share its precompiled headers.
// SPDX-License-Identifier: MIT
int main()
{
    return 0;
}
