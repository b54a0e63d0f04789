#pragma once

struct FDefaultModuleImpl {};
#define IMPLEMENT_MODULE(Kind, Name) Kind Name##Module;
