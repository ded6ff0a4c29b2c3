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
///   W mg/cm2, B gf.cm2/cm, G gf/cm.deg, EMT %, T0 mm; FAST: E5, E20, E100 %, B uN.m, G N/m, W
///   g/m2.
///
/// Stretch: the KES-F curve F = Fm (e/EMT)^p has the measured work where p = 2/LT - 1, Fm = 500
/// gf/cm; its secant at 50 N/m, a load that garments carry, is the stiffness. FAST: the secant at
/// the load nearest to 50 N/m that is given.
#include <garment/garment.hpp>

namespace sloper::garment {

/// @param path  the file, with `#NAME` behind it to pick one fabric of several
/// @throws Error INPUT with line: not a number, unit not known, no bending or no weight
Material read_kes(const std::string& path);

/// A preset's name, or a path that ends in .csv (or .csv#NAME). @throws Error INPUT
Material material_from(const std::string& name_or_path);

} // namespace sloper::garment
