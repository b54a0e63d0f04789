# nix build ./packaging    nix run ./packaging -- run scene.yaml
{
  description = "Burns cloth and paper";
  inputs.nixpkgs.url = "github:NixOS/nixpkgs/nixos-unstable";
  outputs = { self, nixpkgs }:
    let
      systems = [ "x86_64-linux" "aarch64-linux" "aarch64-darwin" ];
      each = f: nixpkgs.lib.genAttrs systems (system: f nixpkgs.legacyPackages.${system});
    in {
      packages = each (pkgs: {
        default = pkgs.stdenv.mkDerivation {
          pname = "singe";
          version = "0.2.0";
          src = ./..;
          nativeBuildInputs = [ pkgs.cmake pkgs.ninja pkgs.pkg-config ];
          buildInputs = with pkgs; [ libfyaml libpng libjpeg embree openexr assimp nlopt ];
          cmakeFlags = [ "-DSINGE_TESTS=OFF" "-DSINGE_PYTHON=OFF" ];
          meta = {
            description = "Burns cloth and paper";
            license = pkgs.lib.licenses.mit;
            mainProgram = "singe";
          };
        };
      });
    };
}
