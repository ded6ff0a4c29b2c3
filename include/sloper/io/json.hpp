#pragma once
/// <io/json_fwd.hpp> with the definition of Json.
#include <nlohmann/json.hpp>
#include <sloper/io/json_fwd.hpp>
