#pragma once
/// Fabric measurements to a material: KES-F (Kawabata 1980) and FAST (De Boos and Tester 1994)
/// values from a CSV file.
///
/// Two layouts, separated by comma, semicolon or tab:
///   one property per row:  `property,unit,warp,weft` (or `mean`), e.g. `B,gf.cm2/cm,0.085,0.052`
///   one fabric per row:    a header such as
///   `fabric,W,B-1,B-2,G-1,G-2,EMT-1,EMT-2,LT-1,LT-2,MIU,T0`, 1 = warp, 2 = weft
/// Units may be given in the unit column or in brackets behind a header's name; without one those
/// of KES-F hold:
///   W mg/cm2, B gf.cm2/cm, G gf/cm.deg, EMT %, T0 mm; FAST: E5, E20, E100, EB5 %, C mm, B uN.m,
///   G N/m, W g/m2; the cantilever of the kitchen table: L mm, the length that hangs over until its
///   end lies 41.5 degrees below the edge.
/// A third direction, bias (`bias` as a column, `-3` or `bias` behind a heading), holds B, C and L
/// at 45 degrees.
///
/// Bending: B as measured; else from the bending length, B = W g C^3 with C = L / 2 at 41.5 degrees
/// (Peirce 1930; BS 3356, FAST-2), along the bias less the strip's twist (bias_of_strip()). Where
/// warp and weft differ, or the bias is given, the fabric bends by direction. Shear without G: 123
/// N/m over EB5 in per cent (FAST-3, bias extension under 5 gf/cm).
///
/// Other values of KES-F and FAST (2HB, WT, RS ...), texts, and columns and rows whose name begins
/// with # are passed over; any other name with a number is refused.
///
/// Stretch: the KES-F curve F = Fm (e/EMT)^p has the measured work where p = 2/LT - 1, Fm = 500
/// gf/cm; its secant at 50 N/m, a load that garments carry, is the stiffness. FAST: the secant at
/// the load nearest to 50 N/m that is given.
/// Test: tests/garment/test_kes.cpp
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// @param path  the file, with `#NAME` behind it to pick one fabric of several
/// @throws Error INPUT with line and column: not a number, a column, property or unit that is not
///   known, one that is there twice, no bending or no weight, a value no cloth has, or one without
///   a unit that no cloth of clothes has in the unit of KES-F
Material read_kes(const std::string& path);

} // namespace sloper::garment
