#pragma once
/// <io/json_fwd.hpp> with the definition of Json.
#include <io/json_fwd.hpp>
#include <nlohmann/json.hpp>
