/* librelief_opencv.so: OpenCV as C functions. One thread, so that the same pictures give the same
 * bits; no exception leaves it. */
#include "calibrate/opencv/shim.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#ifdef RELIEF_HAVE_CHARUCO
#include <opencv2/aruco/charuco.hpp>
#endif

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace
{
thread_local std::string last_error;

/* The half-window of cornerSubPix as a share of the distance to the next corner. Corner
 * localisation is what limits a calibration: a small window wastes the edges, one that reaches the
 * next corner finds something between the two. */
const double window_share = 0.30;
const int window_min = 3, window_max = 11; /* pixels */

/* What the calls of OpenCV share: one thread, and no exception beyond this file. */
template <typename Function> int guarded(Function function)
{
    try {
        cv::setNumThreads(1);
        return function();
    } catch (const std::exception &e) {
        last_error = e.what();
        std::replace(last_error.begin(), last_error.end(), '\n', ' ');
        return -1;
    }
}

cv::Mat wrap(const relief_opencv_gray *gray)
{
    return cv::Mat(gray->height, gray->width, CV_8UC1, const_cast<uint8_t *>(gray->data));
}

double nearest(const std::vector<cv::Point2f> &corners, size_t i)
{
    double best = 1e9;
    for (size_t k = 0; k < corners.size(); k++) {
        if (k != i) {
            best = std::min(best, std::hypot(double(corners[k].x) - corners[i].x,
                                             double(corners[k].y) - corners[i].y));
        }
    }
    return best;
}

/* Each corner with a window of its own; returns the median pitch. */
double refine(const cv::Mat &image, std::vector<cv::Point2f> &corners)
{
    const cv::TermCriteria stop(cv::TermCriteria::EPS + cv::TermCriteria::MAX_ITER, 100, 1e-4);
    std::vector<double> pitch(corners.size());
    for (size_t i = 0; i < corners.size(); i++) {
        pitch[i] = nearest(corners, i);
    }
    for (size_t i = 0; i < corners.size(); i++) {
        const int half = std::clamp(int(window_share * pitch[i] + 0.5), window_min, window_max);
        std::vector<cv::Point2f> one(1, corners[i]);
        cv::cornerSubPix(image, one, cv::Size(half, half), cv::Size(-1, -1), stop);
        corners[i] = one[0];
    }
    std::nth_element(pitch.begin(), pitch.begin() + long(pitch.size() / 2), pitch.end());
    return pitch[pitch.size() / 2];
}

void give(const std::vector<cv::Point2f> &corners, const std::vector<int> &ids, double pitch,
          relief_opencv_corners *out)
{
    out->count = int32_t(corners.size());
    out->pitch = pitch;
    for (size_t i = 0; i < corners.size(); i++) {
        out->id[i] = ids.empty() ? int32_t(i) : ids[i];
        out->u[i] = corners[i].x;
        out->v[i] = corners[i].y;
    }
}

int find_chessboard(const cv::Mat &image, const relief_opencv_board *board,
                    relief_opencv_corners *out)
{
    const cv::Size size(board->columns, board->rows);
    std::vector<cv::Point2f> corners;
    const int quick = board->is_quick ? cv::CALIB_CB_FAST_CHECK : 0;
    bool is_found = cv::findChessboardCorners(
        image, size, corners, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | quick);
    is_found = is_found ||
               (!board->is_quick &&
                cv::findChessboardCornersSB(image, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE));
    if (!is_found) {
        return 0;
    }
    const double pitch = refine(image, corners);
    give(corners, {}, pitch, out);
    const double along = cv::estimateChessboardSharpness(image, size, corners, 0.8F, false)[0];
    const double across = cv::estimateChessboardSharpness(image, size, corners, 0.8F, true)[0];
    const double rise = std::max(along, across);
    out->rise = rise > 0.0 && rise < 1e6 ? rise : 0.0;
    return 1;
}

#ifdef RELIEF_HAVE_CHARUCO
int find_charuco(const cv::Mat &image, const relief_opencv_board *board, relief_opencv_corners *out)
{
    auto dictionary = cv::aruco::getPredefinedDictionary(board->dictionary);
    auto charuco =
        cv::aruco::CharucoBoard::create(board->columns + 1, board->rows + 1, float(board->square),
                                        float(board->marker), dictionary);
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> marker_ids, ids;
    std::vector<cv::Point2f> corners;
    cv::aruco::detectMarkers(image, dictionary, markers, marker_ids);
    if (marker_ids.empty() || cv::aruco::interpolateCornersCharuco(markers, marker_ids, image,
                                                                   charuco, corners, ids) < 6) {
        return 0;
    }
    const double pitch = refine(image, corners);
    give(corners, ids, pitch, out);
    return 1;
}
#else
int find_charuco(const cv::Mat &, const relief_opencv_board *, relief_opencv_corners *)
{
    throw std::runtime_error("this build has no ChArUco boards: " RLF_GET_PART(
        "libopencv-contrib-dev", "script/bootstrap --all", "RELIEF_WITH_OPENCV"));
}
#endif

struct points {
    std::vector<std::vector<cv::Point3f>> board;
    std::vector<std::vector<cv::Point2f>> pixel;
};

points unpack(const relief_opencv_views *views)
{
    points p;
    size_t at = 0;
    for (int32_t i = 0; i < views->count; i++) {
        std::vector<cv::Point3f> board;
        std::vector<cv::Point2f> pixel;
        for (int32_t k = 0; k < views->counts[i]; k++, at++) {
            const float *b = views->board + 3 * at;
            board.emplace_back(b[0], b[1], b[2]);
            pixel.emplace_back(views->pixel[2 * at], views->pixel[2 * at + 1]);
        }
        p.board.push_back(board);
        p.pixel.push_back(pixel);
    }
    return p;
}

void give_lens(const cv::Mat &k, const cv::Mat &distortion, relief_opencv_lens *out)
{
    out->f[0] = k.at<double>(0, 0);
    out->f[1] = k.at<double>(1, 1);
    out->c[0] = k.at<double>(0, 2);
    out->c[1] = k.at<double>(1, 2);
    for (int i = 0; i < 5; i++) {
        out->k[i] = distortion.at<double>(i);
    }
}

cv::Mat matrix(const relief_opencv_lens *lens)
{
    return (cv::Mat_<double>(3, 3) << lens->f[0], 0, lens->c[0], 0, lens->f[1], lens->c[1], 0, 0,
            1);
}

/* calibrate only seeds an optimisation, stereo is compared with its end. */
const cv::TermCriteria rough(cv::TermCriteria::EPS + cv::TermCriteria::MAX_ITER, 30, 1e-4);
const cv::TermCriteria converged(cv::TermCriteria::EPS + cv::TermCriteria::MAX_ITER, 200, 1e-12);
} // namespace

int relief_opencv_version(void)
{
    return RELIEF_OPENCV_VERSION;
}

const char *relief_opencv_error(void)
{
    return last_error.c_str();
}

int relief_opencv_has_charuco(void)
{
#ifdef RELIEF_HAVE_CHARUCO
    return 1;
#else
    return 0;
#endif
}

int relief_opencv_find(const relief_opencv_gray *gray, const relief_opencv_board *board,
                       relief_opencv_corners *out)
{
    *out = {};
    return guarded([&]() {
        const cv::Mat image = wrap(gray);
        return board->is_charuco ? find_charuco(image, board, out)
                                 : find_chessboard(image, board, out);
    });
}

int relief_opencv_size(const relief_opencv_gray *gray, const relief_opencv_board *board,
                       int32_t *out_columns, int32_t *out_rows)
{
    return guarded([&]() {
        const cv::Size size(board->columns, board->rows);
        std::vector<cv::Point2f> corners;
        cv::Mat meta;
        const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER;
        if (!cv::findChessboardCornersSB(wrap(gray), size, corners, flags, meta)) {
            return 0;
        }
        *out_columns = meta.cols;
        *out_rows = meta.rows;
        return meta.cols > 0 ? 1 : 0;
    });
}

int relief_opencv_calibrate(const relief_opencv_views *views, relief_opencv_lens *out,
                            double (*poses)[6], double *out_rms)
{
    return guarded([&]() {
        const points p = unpack(views);
        cv::Mat k, distortion;
        std::vector<cv::Mat> rotations, translations;
        *out_rms = cv::calibrateCamera(p.board, p.pixel, cv::Size(views->width, views->height), k,
                                       distortion, rotations, translations, 0, rough);
        give_lens(k, distortion, out);
        for (size_t i = 0; i < rotations.size(); i++) {
            for (int a = 0; a < 3; a++) {
                poses[i][a] = rotations[i].at<double>(a);
                poses[i][3 + a] = translations[i].at<double>(a);
            }
        }
        return 1;
    });
}

int relief_opencv_stereo(const relief_opencv_views *first, const relief_opencv_views *second,
                         relief_opencv_lens lenses[2], double motion[6], double *out_rms)
{
    return guarded([&]() {
        const points a = unpack(first), b = unpack(second);
        cv::Mat k[2], distortion[2], rotation, translation, essential, fundamental, vector;
        for (int i = 0; i < 2; i++) {
            k[i] = matrix(&lenses[i]);
            distortion[i] = cv::Mat(1, 5, CV_64F, lenses[i].k).clone();
        }
        *out_rms =
            cv::stereoCalibrate(a.board, a.pixel, b.pixel, k[0], distortion[0], k[1], distortion[1],
                                cv::Size(first->width, first->height), rotation, translation,
                                essential, fundamental, cv::CALIB_USE_INTRINSIC_GUESS, converged);
        cv::Rodrigues(rotation, vector);
        for (int i = 0; i < 3; i++) {
            motion[i] = vector.at<double>(i);
            motion[3 + i] = translation.at<double>(i);
        }
        give_lens(k[0], distortion[0], &lenses[0]);
        give_lens(k[1], distortion[1], &lenses[1]);
        return 1;
    });
}
