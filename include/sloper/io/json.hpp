#pragma once
/// <io/json_fwd.hpp> with the definition of Json.
/// Test: tests/io/test_json.cpp
#include <nlohmann/json.hpp>
#include <sloper/io/json_fwd.hpp>
