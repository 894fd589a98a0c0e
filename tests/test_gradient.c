/* Oriented gradients against their definition, pixel by pixel in double: central differences g with replicated edges; in direction
 * u_k = (cos, sin)(k 45 degrees) the response max(0, g . u_k)^4 / |g|^3 times the gain 1 / (local root mean square of |g| + 6); its
 * mean over about a cell; and the bilinear samples of that at the cells' centres, of unit norm. */
#include "gradient.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support_noise.h"
#include "support_pages.h"
#include "support_render.h"
#include "unity.h"

enum { SIDE = 96, MOST_CELLS = AST_MAX_CELLS * AST_MAX_CELLS * AST_DIRECTIONS };

/* Steps of a map's byte for a response of 1, and the norm, in such steps, at which a vector is half as long as it would be. */
static const double unit = 96, small_norm = 9.6;

static unsigned char *block;
static size_t block_size;
static struct ast_gradient gradient;
static float cells[MOST_CELLS];

enum { GUARD = 64, GUARD_BYTE = 0xa5 };

static void lay_out(int side, int count) {
    ast_config cfg;
    struct ast_arena counted = {NULL, 0}, arena;
    TEST_ASSERT_EQUAL_INT(AST_OK, ast_config_preset(&cfg, AST_PRESET_ROBUST));
    cfg.view = side;
    cfg.gradient_cells = count;
    cfg.gradient_weight = 1.0f;
    ast_gradient_layout(&gradient, &cfg, &counted);
    free(block);
    block = malloc(counted.used + AST_ALIGNMENT + GUARD);
    TEST_ASSERT_NOT_NULL(block);
    arena.base = ast_align(block);
    arena.used = 0;
    memset(block, GUARD_BYTE, counted.used + AST_ALIGNMENT + GUARD);
    memset(arena.base, 0xff, counted.used); /* NaN */
    ast_gradient_layout(&gradient, &cfg, &arena);
    TEST_ASSERT_EQUAL_UINT(counted.used, arena.used);
    block_size = arena.used;
}

static void check_guard(void) {
    for (int i = 0; i < GUARD; i++) TEST_ASSERT_EQUAL_HEX8(GUARD_BYTE, ast_align(block)[block_size + (size_t)i]);
}

void setUp(void) {
    lay_out(SIDE, 12);
}
void tearDown(void) {
    check_guard();
    free(block);
    block = NULL;
}

/* ---- The definition ---- */

static int clamped(int i, int count) {
    return i < 0 ? 0 : i < count ? i : count - 1;
}

static double pixel(const ast_frame *image, int x, int y) {
    return image->pixels[(size_t)clamped(y, image->height) * (size_t)image->stride + (size_t)clamped(x, image->width)];
}

static int half_up(double v) {
    return (int)floor(v + 0.5);
}

static int cut; /* responses of the last reference that a byte cannot hold */

/* The blurred responses of an image. What a byte cannot hold is cut off where the rows have been averaged. */
static double *reference(const ast_frame *image, double object_width, double object_height, int count) {
    const int width = image->width, height = image->height;
    const double cell_x = object_width / count, cell_y = object_height / count;
    const int gain_x = half_up(1.5 * cell_x) > 1 ? half_up(1.5 * cell_x) : 1,
              gain_y = half_up(1.5 * cell_y) > 1 ? half_up(1.5 * cell_y) : 1;
    const int blur_x = half_up((cell_x - 1) / 2) > 1 ? half_up((cell_x - 1) / 2) : 1;
    const int blur_y = half_up((cell_y - 1) / 2) > 1 ? half_up((cell_y - 1) / 2) : 1;
    const size_t area = (size_t)width * (size_t)height;
    double *energy = malloc(area * sizeof *energy), *response = malloc(area * AST_DIRECTIONS * sizeof *response);
    double *across = malloc(area * AST_DIRECTIONS * sizeof *across);
    TEST_ASSERT_TRUE(energy != NULL && response != NULL && across != NULL);
#define AT(x, y) ((size_t)clamped(y, height) * (size_t)width + (size_t)clamped(x, width))
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double gx = pixel(image, x + 1, y) - pixel(image, x - 1, y), gy = pixel(image, x, y + 1) - pixel(image, x, y - 1);
            energy[AT(x, y)] = gx * gx + gy * gy;
        }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double gx = pixel(image, x + 1, y) - pixel(image, x - 1, y), gy = pixel(image, x, y + 1) - pixel(image, x, y - 1);
            const double size = sqrt(gx * gx + gy * gy);
            double mean = 0;
            for (int v = -gain_y; v <= gain_y; v++)
                for (int u = -gain_x; u <= gain_x; u++) mean += energy[AT(x + u, y + v)];
            mean /= (2 * gain_x + 1) * (2 * gain_y + 1);
            for (int k = 0; k < AST_DIRECTIONS; k++) {
                const double turn = k * 0.7853981633974483, along = gx * cos(turn) + gy * sin(turn);
                const double fourth = along > 0 ? pow(along, 4) / pow(size, 3) : 0;
                response[AT(x, y) * AST_DIRECTIONS + (size_t)k] = fourth / (sqrt(mean) + 6);
            }
        }
    cut = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (size_t k = 0; k < AST_DIRECTIONS; k++) {
                double sum = 0;
                for (int u = -blur_x; u <= blur_x; u++) sum += response[AT(x + u, y) * AST_DIRECTIONS + k] / (2 * blur_x + 1);
                cut += sum > 255 / unit;
                across[AT(x, y) * AST_DIRECTIONS + k] = fmin(sum, 255 / unit);
            }
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (size_t k = 0; k < AST_DIRECTIONS; k++) {
                double sum = 0;
                for (int v = -blur_y; v <= blur_y; v++) sum += across[AT(x, y + v) * AST_DIRECTIONS + k] / (2 * blur_y + 1);
                response[AT(x, y) * AST_DIRECTIONS + k] = sum;
            }
#undef AT
    free(energy);
    free(across);
    return response;
}

static double map_byte(int x, int y, int k) {
    return gradient.maps[((size_t)y * (size_t)gradient.side + (size_t)x) * AST_DIRECTIONS + (size_t)k];
}

/* Bytes are rounded twice, after each axis: together less than one step. */
static void assert_maps(const ast_frame *image, float object_width, float object_height) {
    double *expected = reference(image, (double)object_width, (double)object_height, gradient.cells);
    ast_gradient_prepare(&gradient, image, object_width, object_height);
    TEST_ASSERT_EQUAL_INT(image->width, gradient.width);
    TEST_ASSERT_EQUAL_INT(image->height, gradient.height);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int k = 0; k < AST_DIRECTIONS; k++) {
                const double steps = unit * expected[(y * image->width + x) * AST_DIRECTIONS + k];
                TEST_ASSERT_DOUBLE_WITHIN(1.02, steps, map_byte(x, y, k));
            }
    free(expected);
}

/* ---- Pictures ---- */

static ast_frame noise_image(uint8_t *pixels, int width, int height, uint64_t seed) {
    struct noise noise = {seed};
    for (int i = 0; i < width * height; i++) pixels[i] = (uint8_t)noise_bits(&noise);
    const ast_frame image = {pixels, width, height, width};
    return image;
}

/* A texture of natural smoothness, in levels around the middle: gain and offset do not cut it. */
static ast_frame texture_image(uint8_t *pixels, int width, int height, uint64_t seed, double gain, double offset) {
    struct render scene;
    render_open(&scene, width, height, seed);
    for (int i = 0; i < width * height; i++) pixels[i] = (uint8_t)(gain * floor(20 + 200 * (double)scene.ground[i]) + offset + 0.5);
    render_close(&scene);
    const ast_frame image = {pixels, width, height, width};
    return image;
}

static double norm_of(const float *v, int length) {
    double sum = 0;
    for (int i = 0; i < length; i++) sum += (double)v[i] * (double)v[i];
    return sqrt(sum);
}

static double distance_of(const float *a, const float *b, int length) {
    double sum = 0;
    for (int i = 0; i < length; i++) sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
    return sqrt(sum);
}

static int length_of(void) {
    return gradient.cells * gradient.cells * AST_DIRECTIONS;
}

/* ---- Maps ---- */

static void test_maps_are_the_definition(void) {
    static const int shapes[][2] = {{1, 1}, {2, 1}, {1, 9}, {3, 3}, {40, 25}, {61, 96}, {96, 96}};
    static const float objects[][2] = {{36, 36}, {24, 54}, {13, 9}, {3, 2}};
    static uint8_t pixels[SIDE * SIDE];
    for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++)
        for (size_t o = 0; o < sizeof objects / sizeof objects[0]; o++) {
            const ast_frame noise = noise_image(pixels, shapes[s][0], shapes[s][1], 1 + s);
            assert_maps(&noise, objects[o][0], objects[o][1]);
            const ast_frame texture = texture_image(pixels, shapes[s][0], shapes[s][1], 1 + s, 1.0, 0.0);
            assert_maps(&texture, objects[o][0], objects[o][1]);
        }
}

/* Few and many cells: blurs from the least radius to one wider than the image. */
static void test_maps_for_every_number_of_cells(void) {
    static const int counts[] = {2, 3, 5, AST_MAX_CELLS};
    uint8_t pixels[48 * 30];
    const ast_frame texture = texture_image(pixels, 48, 30, 3, 1.0, 0.0);
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        lay_out(48, counts[c]);
        assert_maps(&texture, 40, 28);
        assert_maps(&texture, 190, 100);
        check_guard();
    }
}

/* Full contrast: lonely strokes, lines, steps and squares. A stroke in an object of thin cells, whose surroundings are tall and
 * empty, exceeds what a byte holds, and is cut off there. */
static void test_maps_of_the_strongest_edges(void) {
    static uint8_t pixels[SIDE * SIDE];
    static const float objects[][2] = {{36, 36}, {12, 240}, {90, 12}};
    const ast_frame image = {pixels, SIDE, SIDE, SIDE};
    int cuts = 0;
    for (size_t o = 0; o < sizeof objects / sizeof objects[0]; o++)
        for (int picture = 0; picture < 4; picture++) {
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    const int white = picture == 0   ? x % 32 < 3 && y == 48
                                      : picture == 1 ? x % 32 == 20
                                      : picture == 2 ? y > 40
                                                     : (x / 7 + y / 7) % 2;
                    pixels[y * SIDE + x] = white ? 255 : 0;
                }
            assert_maps(&image, objects[o][0], objects[o][1]);
            cuts += cut;
        }
    TEST_ASSERT_TRUE(cuts > 0); /* the limit has been seen */
}

/* A plane has one gradient g everywhere inside: a response |g| cos^4 / (|g| + 6) for the angle between, none beyond a right one. */
static void test_a_plane_answers_in_its_own_direction(void) {
    static uint8_t pixels[SIDE * SIDE];
    const ast_frame image = {pixels, SIDE, SIDE, SIDE};
    static const int slopes[][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    for (int k = 0; k < AST_DIRECTIONS; k++) {
        for (int i = 0; i < SIDE * SIDE; i++)
            pixels[i] = (uint8_t)(128 + slopes[k][0] * (i % SIDE - 48) + slopes[k][1] * (i / SIDE - 48));
        ast_gradient_prepare(&gradient, &image, 36, 36);
        const double size = 2 * sqrt(slopes[k][0] * slopes[k][0] + slopes[k][1] * slopes[k][1]), peak = unit * size / (size + 6);
        for (int other = 0; other < AST_DIRECTIONS; other++) {
            const double cosine = cos((other - k) * 0.7853981633974483);
            TEST_ASSERT_DOUBLE_WITHIN(1.0, cosine > 0 ? peak * pow(cosine, 4) : 0, map_byte(48, 48, other));
        }
    }
}

static void test_maps_forget_the_last_image(void) {
    static uint8_t large[SIDE * SIDE], small[30 * 20];
    static uint8_t first[SIDE * SIDE * AST_DIRECTIONS];
    const ast_frame image = texture_image(small, 30, 20, 4, 1.0, 0.0), other = noise_image(large, SIDE, SIDE, 5);
    ast_gradient_prepare(&gradient, &image, 24, 18);
    memcpy(first, gradient.maps, sizeof first);
    ast_gradient_prepare(&gradient, &other, 80, 12);
    ast_gradient_prepare(&gradient, &image, 24, 18);
    for (int y = 0; y < 20; y++)
        TEST_ASSERT_EQUAL_MEMORY(first + y * SIDE * AST_DIRECTIONS, gradient.maps + y * SIDE * AST_DIRECTIONS, 30 * AST_DIRECTIONS);
}

/* The image's first byte follows a page that cannot be read, then its last byte precedes one. */
static void test_no_byte_outside_the_image_is_read(void) {
    static const int shapes[][3] = {{1, 1, 1}, {1, 40, 1}, {40, 1, 40}, {23, 17, 23}, {23, 17, 61}, {96, 96, 4096}};
    for (size_t s = 0; s < sizeof shapes / sizeof shapes[0]; s++) {
        const int width = shapes[s][0], height = shapes[s][1], stride = shapes[s][2];
        const size_t bytes = (size_t)(height - 1) * (size_t)stride + (size_t)width;
        struct pages pages;
        pages_open(&pages, bytes);
        for (int end = 0; end < 2; end++) {
            const ast_frame image = {end ? pages.end - bytes : pages.first, width, height, stride};
            const ast_box window = {-5, -7, 60, 50};
            ast_gradient_prepare(&gradient, &image, 36, 20);
            ast_gradient_cells(&gradient, &window, cells);
            TEST_ASSERT_DOUBLE_WITHIN(0, 0, norm_of(cells, length_of())); /* the pages hold one level */
        }
        pages_close(&pages);
    }
}

static void test_padding_is_never_seen(void) {
    enum { WIDTH = 33, HEIGHT = 21, STRIDE = 50 };
    static uint8_t packed[WIDTH * HEIGHT], padded[STRIDE * HEIGHT];
    const ast_frame plain = noise_image(packed, WIDTH, HEIGHT, 6), wide = {padded, WIDTH, HEIGHT, STRIDE};
    const ast_box window = {3, 2, 28, 17};
    float expected[MOST_CELLS];
    memset(padded, 0x55, sizeof padded);
    for (int y = 0; y < HEIGHT; y++) memcpy(padded + y * STRIDE, packed + y * WIDTH, WIDTH);
    ast_gradient_prepare(&gradient, &plain, 28, 17);
    ast_gradient_cells(&gradient, &window, expected);
    ast_gradient_prepare(&gradient, &wide, 28, 17);
    ast_gradient_cells(&gradient, &window, cells);
    TEST_ASSERT_EQUAL_MEMORY(expected, cells, (size_t)length_of() * sizeof *cells);
}

/* ---- Cells ---- */

static void test_cells_times_their_weight(void) {
    enum { EDGE = 40 };
    static uint8_t pixels[EDGE * EDGE];
    const ast_frame image = noise_image(pixels, EDGE, EDGE, 11);
    const ast_box window = {4.25f, 3.5f, 30, 31};
    float plain[MOST_CELLS];
    ast_gradient_prepare(&gradient, &image, 30, 31);
    ast_gradient_cells(&gradient, &window, plain);
    gradient.weight = 1.4f;
    ast_gradient_cells(&gradient, &window, cells);
    for (int i = 0; i < length_of(); i++) TEST_ASSERT_TRUE(cells[i] == plain[i] * 1.4f);
}

static double bilinear(double x, double y, int k) {
    const int left = (int)floor(x), top = (int)floor(y);
    const int x0 = clamped(left, gradient.width), x1 = clamped(left + 1, gradient.width);
    const int y0 = clamped(top, gradient.height), y1 = clamped(top + 1, gradient.height);
    const double u = x - left, v = y - top;
    return (1 - v) * ((1 - u) * map_byte(x0, y0, k) + u * map_byte(x1, y0, k)) +
           v * ((1 - u) * map_byte(x0, y1, k) + u * map_byte(x1, y1, k));
}

/* Bilinear samples of the maps at the cells' centres, edges replicated, divided by their norm and a little. */
static void assert_cells(const ast_box *window) {
    const int count = gradient.cells, length = length_of();
    double expected[MOST_CELLS], norm = 0;
    for (int i = 0; i < length; i++) {
        const int k = i % AST_DIRECTIONS, c = i / AST_DIRECTIONS % count, r = i / AST_DIRECTIONS / count;
        expected[i] = bilinear((double)window->x + (c + 0.5) * (double)window->w / count - 0.5,
                               (double)window->y + (r + 0.5) * (double)window->h / count - 0.5, k);
        norm += expected[i] * expected[i];
    }
    for (int i = 0; i < MOST_CELLS; i++) cells[i] = NAN;
    ast_gradient_cells(&gradient, window, cells);
    for (int i = 0; i < length; i++) TEST_ASSERT_DOUBLE_WITHIN(3e-6, expected[i] / (sqrt(norm) + small_norm), (double)cells[i]);
    for (int i = length; i < MOST_CELLS; i++) TEST_ASSERT_TRUE(isnan(cells[i])); /* not a float more */
}

static void test_cells_are_read_off_the_maps(void) {
    static const int counts[] = {2, 7, 12, AST_MAX_CELLS};
    static uint8_t pixels[70 * 52];
    const ast_frame image = noise_image(pixels, 70, 52, 7);
    struct noise noise = {8};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        lay_out(SIDE, counts[c]);
        ast_gradient_prepare(&gradient, &image, 36, 30);
        for (int trial = 0; trial < 60; trial++) { /* within the image and around it */
            const ast_box window = {(float)(140 * noise_uniform(&noise) - 50), (float)(110 * noise_uniform(&noise) - 40),
                                    (float)exp(5 * noise_uniform(&noise)), (float)exp(5 * noise_uniform(&noise))};
            assert_cells(&window);
        }
        static const ast_box far[] = {{-500, 10, 30, 30}, {20, 900, 30, 30}, {-3000, -3000, 6000, 6000}};
        for (size_t f = 0; f < sizeof far / sizeof far[0]; f++) assert_cells(&far[f]);
    }
}

/* A window beyond a corner shows what lies there, again and again. */
static void test_a_window_outside_repeats_the_corner(void) {
    static uint8_t pixels[40 * 40];
    const ast_frame image = noise_image(pixels, 40, 40, 9);
    const ast_box window = {60, -90, 30, 30};
    ast_gradient_prepare(&gradient, &image, 30, 30);
    ast_gradient_cells(&gradient, &window, cells);
    for (int i = AST_DIRECTIONS; i < length_of(); i++) TEST_ASSERT_FLOAT_WITHIN(1e-7f, cells[i % AST_DIRECTIONS], cells[i]);
    for (int k = 0; k < AST_DIRECTIONS; k++) {
        const double ratio = map_byte(39, 0, k) / fmax(map_byte(39, 0, 0), 1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, ratio * (double)cells[0], (double)cells[k]);
    }
}

static void test_cells_have_unit_norm(void) {
    static uint8_t pixels[SIDE * SIDE];
    const ast_box window = {20.3f, 31.8f, 36, 36};
    for (uint64_t seed = 10; seed < 20; seed++) {
        const ast_frame image = texture_image(pixels, SIDE, SIDE, seed, 1.0, 0.0);
        ast_gradient_prepare(&gradient, &image, 36, 36);
        ast_gradient_cells(&gradient, &window, cells);
        TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.985, norm_of(cells, length_of()));
    }
}

/* No edge, no vector: not a direction made of nothing. A single faint edge gives a short one. */
static void test_flat_windows_stay_small(void) {
    static uint8_t pixels[SIDE * SIDE];
    const ast_frame image = {pixels, SIDE, SIDE, SIDE};
    const ast_box window = {20, 20, 36, 36};
    static const int levels[] = {0, 1, 128, 255};
    for (size_t l = 0; l < sizeof levels / sizeof levels[0]; l++) {
        memset(pixels, levels[l], sizeof pixels);
        ast_gradient_prepare(&gradient, &image, 36, 36);
        ast_gradient_cells(&gradient, &window, cells);
        for (int i = 0; i < length_of(); i++) TEST_ASSERT_TRUE(cells[i] == 0.0f);
    }
    pixels[38 * SIDE + 38] = 252; /* three levels below the others */
    ast_gradient_prepare(&gradient, &image, 36, 36);
    ast_gradient_cells(&gradient, &window, cells);
    TEST_ASSERT_TRUE(norm_of(cells, length_of()) > 0.5 && norm_of(cells, length_of()) < 0.9);
}

/* ---- Invariances ---- */

/* A quarter turn of the image moves cell (r, c) to (c, last - r) and direction k to k + 2. */
static void test_a_quarter_turn_permutes_cells_and_directions(void) {
    enum { WIDTH = 70, HEIGHT = 56, COUNT = 12 };
    static uint8_t upright[WIDTH * HEIGHT], turned[WIDTH * HEIGHT];
    float before[MOST_CELLS];
    for (uint64_t seed = 20; seed < 24; seed++) {
        const ast_frame image = texture_image(upright, WIDTH, HEIGHT, seed, 1.0, 0.0), rotated = {turned, HEIGHT, WIDTH, HEIGHT};
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++) turned[x * HEIGHT + (HEIGHT - 1 - y)] = upright[y * WIDTH + x]; /* x axis onto y axis */
        const ast_box window = {17.25f, 9.5f, 40, 33}, window_turned = {HEIGHT - 9.5f - 33, 17.25f, 33, 40};
        ast_gradient_prepare(&gradient, &image, 40, 33);
        ast_gradient_cells(&gradient, &window, before);
        ast_gradient_prepare(&gradient, &rotated, 33, 40);
        ast_gradient_cells(&gradient, &window_turned, cells);
        for (int r = 0; r < COUNT; r++)
            for (int c = 0; c < COUNT; c++)
                for (int k = 0; k < AST_DIRECTIONS; k++) {
                    const int from = (r * COUNT + c) * AST_DIRECTIONS + k;
                    const int to = (c * COUNT + COUNT - 1 - r) * AST_DIRECTIONS + (k + 2) % AST_DIRECTIONS;
                    TEST_ASSERT_FLOAT_WITHIN(2e-3f, before[from], cells[to]); /* bytes are rounded along one axis, then the other */
                }
    }
}

/* An offset of the light changes no difference of pixels: the same bits. */
static void test_offset_of_the_light_changes_nothing(void) {
    static uint8_t dark[SIDE * SIDE], bright[SIDE * SIDE];
    const ast_frame image = texture_image(dark, SIDE, SIDE, 25, 0.5, 0.0), brighter = {bright, SIDE, SIDE, SIDE};
    const ast_box window = {20, 30, 40, 36};
    float before[MOST_CELLS];
    for (int i = 0; i < SIDE * SIDE; i++) bright[i] = (uint8_t)(dark[i] + 120);
    ast_gradient_prepare(&gradient, &image, 40, 36);
    ast_gradient_cells(&gradient, &window, before);
    ast_gradient_prepare(&gradient, &brighter, 40, 36);
    ast_gradient_cells(&gradient, &window, cells);
    TEST_ASSERT_EQUAL_MEMORY(before, cells, (size_t)length_of() * sizeof *cells);
}

/* Contrast, too, is evened out; what remains of a gain is the noise floor of 6 levels and the rounding of grey levels. The unit
 * vector of a texture moves by less than these lengths; that of another texture is 1 away. */
static void test_gain_of_the_light_changes_little(void) {
    static const struct { double gain, offset, limit; } lights[] = {{0.7, 20, 0.03}, {0.5, 60, 0.04}, {1.1, 0, 0.025}};
    static uint8_t plain[SIDE * SIDE], lit[SIDE * SIDE];
    const ast_box window = {20.3f, 31.8f, 36, 36};
    float before[MOST_CELLS];
    for (uint64_t seed = 30; seed < 40; seed++) {
        const ast_frame image = texture_image(plain, SIDE, SIDE, seed, 1.0, 0.0);
        ast_gradient_prepare(&gradient, &image, 36, 36);
        ast_gradient_cells(&gradient, &window, before);
        for (size_t l = 0; l < sizeof lights / sizeof lights[0]; l++) {
            const ast_frame other = texture_image(lit, SIDE, SIDE, seed, lights[l].gain, lights[l].offset);
            ast_gradient_prepare(&gradient, &other, 36, 36);
            ast_gradient_cells(&gradient, &window, cells);
            TEST_ASSERT_TRUE(distance_of(before, cells, length_of()) < lights[l].limit);
        }
        const ast_frame stranger = texture_image(lit, SIDE, SIDE, seed + 100, 1.0, 0.0);
        ast_gradient_prepare(&gradient, &stranger, 36, 36);
        ast_gradient_cells(&gradient, &window, cells);
        TEST_ASSERT_TRUE(distance_of(before, cells, length_of()) > 0.9);
    }
}

int main(void) {
    UNITY_BEGIN();
    RUN_TEST(test_maps_are_the_definition);
    RUN_TEST(test_maps_for_every_number_of_cells);
    RUN_TEST(test_maps_of_the_strongest_edges);
    RUN_TEST(test_a_plane_answers_in_its_own_direction);
    RUN_TEST(test_maps_forget_the_last_image);
    RUN_TEST(test_no_byte_outside_the_image_is_read);
    RUN_TEST(test_padding_is_never_seen);
    RUN_TEST(test_cells_times_their_weight);
    RUN_TEST(test_cells_are_read_off_the_maps);
    RUN_TEST(test_a_window_outside_repeats_the_corner);
    RUN_TEST(test_cells_have_unit_norm);
    RUN_TEST(test_flat_windows_stay_small);
    RUN_TEST(test_a_quarter_turn_permutes_cells_and_directions);
    RUN_TEST(test_offset_of_the_light_changes_nothing);
    RUN_TEST(test_gain_of_the_light_changes_little);
    return UNITY_END();
}
