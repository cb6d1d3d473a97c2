# What is run often; `.ci/run` is all of it. https://just.systems

export CARGO_PROFILE_RELEASE_LTO := "off"
export CARGO_PROFILE_RELEASE_CODEGEN_UNITS := "16"

# List these
default:
    @just --list

# Format, lints, documentation
lint:
    cargo fmt --check
    cargo clippy --release --all-targets --locked -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --no-deps --locked

# Unit tests: seconds
unit:
    cargo test --release --locked --lib

# One file of tests/, or all: `just test val_laws`
test *files:
    cargo test --release --locked {{ if files == "" { "" } else { "--test " + replace(files, " ", " --test ") } }}

# Golden results written anew, after a change that was meant to change them
golden:
    FREEPLAY_WRITE_GOLDEN=1 cargo test --release --locked --test golden

# Speed against the minimal-coordinate solver, with the profile that users get
bench:
    env -u CARGO_PROFILE_RELEASE_LTO -u CARGO_PROFILE_RELEASE_CODEGEN_UNITS cargo bench --bench work_precision

# Each reader is fuzzed for so many seconds
fuzz seconds="60":
    fuzz/run {{ seconds }}

# Everything that must hold
ci:
    .ci/run
