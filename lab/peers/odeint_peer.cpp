// Boost.odeint: dopri5 and rkf78 with controlled steps, and bulirsch_stoer, on the right-hand sides of cases.json, which
// `run` writes to systems.hpp. Answers the requests that server.py describes, in the plainest form: a line
// `case NAME KEEP BUDGET TARGET...` and a line `round`.
//
//     g++ -O3 -march=native -std=gnu++17 -I FOLDER_OF_SYSTEMS odeint_peer.cpp -o odeint_peer

#include <time.h>

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

inline double rsqrt(double x) { return 1.0 / std::sqrt(x); }
using std::cos;
using std::exp;

namespace odeint = boost::numeric::odeint;

static double processor() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static double wall() {
  auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

// A sample lasts about so many seconds.
const double SAMPLE = 1.5e-3;
// What takes longer is tried once; else three times.
const double ONCE = 5e-3;

struct Trial {
  const char *method;
  double tolerance, error, first;
  size_t steps;
  std::function<size_t(double &)> run;
};

// Case D, in components: all first ones, all second ones, all third ones.
template <class State>
void chain(const State &y, State &d) {
  const size_t n = y.size() / 3;
  const double *x = y.data(), *u = x + n, *v = u + n;
  double *dx = d.data(), *du = dx + n, *dv = du + n;
  auto turn = [=](size_t l, size_t i, size_t r) {
    const double a = x[l] + x[r], b = u[l] + u[r], c = v[l] + v[r];
    dx[i] = b * v[i] - c * u[i];
    du[i] = c * x[i] - a * v[i];
    dv[i] = a * u[i] - b * x[i];
  };
  turn(n - 1, 0, 1);
#pragma GCC ivdep
  for (size_t i = 1; i < n - 1; i++) turn(i - 1, i, i + 1);
  turn(n - 2, n - 1, 0);
}


struct Request {
  size_t keep;
  double budget;
  std::vector<double> targets;
};

#include "systems.hpp"

static std::vector<Trial> trials;

template <class Case, class Make>
static void attempt(const char *method, const Request &request, Make make) {
  using State = typename Case::State;
  for (int k = 8; k < 64; k++) {
    const double tolerance = std::pow(10.0, -0.25 * k);
    auto run = [=](double &error) {
      State y = Case::start();
      const size_t steps =
          odeint::integrate_adaptive(make(tolerance), Case::field, y, 0.0, Case::until(), 0.01);
      error = Case::error(y);
      return steps;
    };
    Trial trial{method, tolerance, 0.0, 1e300, 0, run};
    for (int i = 0; i < 3 && (i == 0 || trial.first < ONCE); i++) {
      const double before = processor();
      trial.steps = run(trial.error);
      trial.first = std::min(trial.first, processor() - before);
    }
    if (std::isfinite(trial.error)) trials.push_back(trial);
    if (trial.first > request.budget) break;
  }
}

template <class Case>
static void prepare(const Request &request) {
  using State = typename Case::State;
  trials.clear();
  attempt<Case>("dopri5", request, [](double t) {
    return odeint::make_controlled(t, t, odeint::runge_kutta_dopri5<State>());
  });
  attempt<Case>("rkf78", request, [](double t) {
    return odeint::make_controlled(t, t, odeint::runge_kutta_fehlberg78<State>());
  });
  attempt<Case>("bulirsch_stoer", request,
                [](double t) { return odeint::bulirsch_stoer<State>(t, t); });
  std::vector<Trial> kept;
  for (const char *method : {"dopri5", "rkf78", "bulirsch_stoer"}) {
    std::vector<bool> keep(trials.size(), false);
    for (double target : request.targets) {
      std::vector<size_t> good;
      for (size_t i = 0; i < trials.size(); i++)
        if (trials[i].method == std::string(method) && trials[i].error <= target) good.push_back(i);
      std::sort(good.begin(), good.end(),
                [](size_t i, size_t j) { return trials[i].first < trials[j].first; });
      for (size_t i = 0; i < std::min(request.keep, good.size()); i++) keep[good[i]] = true;
    }
    for (size_t i = 0; i < trials.size(); i++)
      if (keep[i]) kept.push_back(trials[i]);
  }
  trials = kept;
  std::printf("{\"rows\": [");
  for (size_t i = 0; i < trials.size(); i++) {
    const Trial &t = trials[i];
    std::printf(
        "%s{\"peer\": \"Boost.odeint\", \"method\": \"%s\", \"by\": \"tolerance\", \"setting\": \"tol "
        "%.1e\", \"error\": %.17g, \"steps\": %zu, \"drift\": null, \"first\": %.17g}",
        i ? ", " : "", t.method, t.tolerance, t.error, t.steps, t.first);
  }
  std::printf("]}\n");
}

static void round() {
  std::printf("{\"samples\": [");
  for (size_t i = 0; i < trials.size(); i++) {
    const int times = std::max(1, int(SAMPLE / trials[i].first));
    double error, seconds = processor(), passed = wall();
    volatile double sink;
    for (int k = 0; k < times; k++) {
      trials[i].run(error);
      sink = error;
    }
    (void)sink;
    seconds = processor() - seconds, passed = wall() - passed;
    std::printf("%s[%.17g, %.17g]", i ? ", " : "", seconds / times, passed / times);
  }
  std::printf("]}\n");
}

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string kind, name;
    words >> kind;
    if (kind == "case") {
      Request request{};
      words >> name >> request.keep >> request.budget;
      for (double target; words >> target;) request.targets.push_back(target);
      DISPATCH(name, request)
    } else {
      round();
    }
    std::fflush(stdout);
  }
}
