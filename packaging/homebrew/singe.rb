# brew install --build-from-source packaging/homebrew/singe.rb, beside singe-0.2.0.tar.gz of scripts/release.py
class Singe < Formula
  desc "Burns cloth and paper"
  homepage "file://#{__dir__}"
  url "file://#{__dir__}/singe-0.2.0.tar.gz"
  license "MIT"

  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "pkgconf" => :build
  depends_on "assimp"
  depends_on "embree"
  depends_on "jpeg-turbo"
  depends_on "libfyaml"
  depends_on "libpng"
  depends_on "nlopt"
  depends_on "openexr"

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DSINGE_TESTS=OFF", "-DSINGE_PYTHON=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    (testpath/"scene.yaml").write "frames: 2\ngas: no\nsheets: [{grid: {size: [6 cm, 6 cm], cells: [8, 8]}}]\n"
    system bin/"singe", "run", "scene.yaml", "-o", "out", "--no-preview"
    assert_predicate testpath/"out/run.json", :exist?
  end
end
