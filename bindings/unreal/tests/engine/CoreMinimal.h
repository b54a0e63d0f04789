// What the module calls of Unreal, in our own words, so that it compiles and runs without the engine: lengths and types are
// checked, and errors are kept.
#pragma once

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

typedef int32_t int32;
typedef int64_t int64;
typedef uint8_t uint8;
typedef uint32_t uint32;
typedef char TCHAR;
#define TEXT(words) words
#define SINGEUNREAL_API
#define UCLASS(...)
#define UPROPERTY(...)
#define UFUNCTION(...)
#define GENERATED_BODY() using Super = UProceduralMeshComponent;
#define UTF8_TO_TCHAR(words) (words)
#define TCHAR_TO_UTF8(words) (words)
#define DEFINE_LOG_CATEGORY_STATIC(Category, Default, Compiled)
#define UE_LOG(Category, Verbosity, ...) LogError(__VA_ARGS__)

inline std::vector<std::string> Errors;

inline void LogError(const char *Format, ...) {
    char Line[512];
    va_list Arguments;
    va_start(Arguments, Format);
    vsnprintf(Line, sizeof Line, Format, Arguments);
    va_end(Arguments);
    Errors.push_back(Line);
}

struct FVector {
    double X, Y, Z;
    FVector(double InX = 0, double InY = 0, double InZ = 0) : X(InX), Y(InY), Z(InZ) {}
};

struct FVector2D {
    double X, Y;
    FVector2D(double InX = 0, double InY = 0) : X(InX), Y(InY) {}
};

struct FIntPoint {
    int32 X, Y;
    FIntPoint(int32 InX, int32 InY) : X(InX), Y(InY) {}
};

struct FColor {
    uint8 R, G, B, A;
    FColor(uint8 InR = 0, uint8 InG = 0, uint8 InB = 0, uint8 InA = 255) : R(InR), G(InG), B(InB), A(InA) {}
};

enum class EAllowShrinking { No, Yes };

template <typename Element> class TArray {
  public:
    void SetNumUninitialized(int32 Count, EAllowShrinking) { Elements.resize(static_cast<size_t>(Count)); }
    int32 Num() const { return static_cast<int32>(Elements.size()); }
    Element &operator[](int32 Index) { return Elements.at(static_cast<size_t>(Index)); }
    const Element &operator[](int32 Index) const { return Elements.at(static_cast<size_t>(Index)); }

  private:
    std::vector<Element> Elements;
};

struct FString {
    std::string Words;
    FString(const char *InWords) : Words(InWords) {}
    const char *operator*() const { return Words.c_str(); }
};

struct FCStringAnsi {
    static void Strncpy(char *To, const char *From, size_t Size) { snprintf(To, Size, "%s", From); }
};

struct FMath {
    static int32 Max(int32 A, int32 B) { return A > B ? A : B; }
};

template <typename Object> class TUniquePtr {
  public:
    TUniquePtr() = default;
    explicit TUniquePtr(Object *Made) : Held(Made) {}
    Object *Get() const { return Held.get(); }
    void Reset() { Held.reset(); }
    bool IsValid() const { return Held != nullptr; }
    explicit operator bool() const { return IsValid(); }
    Object *operator->() const { return Held.get(); }

  private:
    std::unique_ptr<Object> Held;
};

template <typename Object> TUniquePtr<Object> MakeUnique(const Object &From) {
    return TUniquePtr<Object>(new Object(From));
}
