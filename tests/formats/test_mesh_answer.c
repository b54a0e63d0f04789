// The answer of a reader in a child process is checked like a file.
#include "formats/mesh_reader.h"
#include "format_test.h"

/// A square with uv, and a triangle.
typedef struct Answer {
    MeshCounts counts;
    float positions[12];
    uint32_t sizes[2], corners[7];
    float uv[14];
} Answer;

enum { WHOLE = offsetof(Answer, uv) + sizeof(float[14]), WITHOUT_UV = offsetof(Answer, uv) };

static Answer good(void) {
    return (Answer){{4, 2, 7, 1}, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {4, 3}, {0, 1, 2, 3, 0, 2, 3}, {.5f}};
}

static SingeResult take(const Answer *answer, size_t size, Polygons *polygons, SingeError *error) {
    uint8_t *bytes = malloc(size ? size : 1); // a sanitizer sees a read behind the end
    memcpy(bytes, answer, size);

    SingeResult result = mesh_answer_take("a.glb", bytes, size, (SingeAllocator){0}, polygons, error);
    free(bytes);
    if (result) {
        assert_null(polygons->positions);
        assert_message(error, "a.glb");
    }

    return result;
}

TEST(good_answers_are_taken) {
    Polygons polygons;
    SingeError error;
    Answer answer = good();
    answer.uv[3] = NAN;
    if (take(&answer, WHOLE, &polygons, &error)) fail_msg("%s", error.message);
    assert_int_equal(polygons.vertex_count, 4);
    assert_int_equal(polygons.face_count, 2);

    static const uint32_t first[] = {0, 4, 7};
    assert_memory_equal(polygons.first, first, sizeof first);
    assert_memory_equal(polygons.corners, answer.corners, sizeof answer.corners);
    assert_memory_equal(polygons.positions, answer.positions, sizeof answer.positions);
    assert_true(polygons.uv[0] == .5f && polygons.uv[3] == 0);

    polygons_free(&polygons);
    answer.counts.uv = 0;
    assert_int_equal(take(&answer, WITHOUT_UV, &polygons, &error), SINGE_OK);
    assert_null(polygons.uv);
    polygons_free(&polygons);
}

TEST(damaged_answers_are_refused) {
    Polygons polygons;
    SingeError error;
    Answer answer = good();

    for (size_t size = 0; size < WHOLE; size++)
        assert_int_equal(take(&answer, size, &polygons, &error), SINGE_ERROR_FORMAT);

    static const uint64_t wrong[] = {0, 1, 3, 5, 8, 0x7fffffff, 0x80000000, 0x5555555555555559, UINT64_MAX};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        for (int field = 0; field < 4; field++) {
            uint64_t counts[4] = {4, 2, 7, 1};
            if (counts[field] == wrong[i]) continue;
            counts[field] = wrong[i];
            answer.counts = (MeshCounts){counts[0], counts[1], counts[2], counts[3]};
            assert_int_equal(take(&answer, WHOLE, &polygons, &error), SINGE_ERROR_FORMAT);
        }

    answer = good(), answer.corners[3] = 4;
    assert_int_equal(take(&answer, WHOLE, &polygons, &error), SINGE_ERROR_FORMAT);

    static const uint32_t sizes[][2] = {{5, 2}, {2, 5}, {4, 4}, {3, 3}, {7, 0}, {0xfffffffc, 11}, {4, 0xffffffff}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        answer = good(), answer.sizes[0] = sizes[i][0], answer.sizes[1] = sizes[i][1];
        assert_int_equal(take(&answer, WHOLE, &polygons, &error), SINGE_ERROR_FORMAT);
    }

    answer = good(), answer.positions[7] = INFINITY;
    assert_int_equal(take(&answer, WHOLE, &polygons, &error), SINGE_ERROR_MESH);
    assert_message(&error, "vertex 2");

    MeshCounts none = {0};
    assert_int_equal(
        mesh_answer_take("a.glb", (const uint8_t *)&none, sizeof none, (SingeAllocator){0}, &polygons, &error),
        SINGE_ERROR_MESH);
    assert_message(&error, "no faces");
}

TEST(failing_memory_is_reported) {
    Answer answer = good();
    Polygons polygons;
    SingeError error;
    test_allocations_fail(0, mesh_answer_take("a.glb", (const uint8_t *)&answer, WHOLE, allocator, &polygons, &error),
                          polygons_free(&polygons));
}
