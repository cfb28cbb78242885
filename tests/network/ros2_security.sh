#!/bin/sh
# DDS Security by certificates: ros2_security.sh BENCH WORK. Who has a certificate of our authority reads
# the camera, encrypted; who has none reads nothing. Exit status 77 (a skip) without openssl or the
# plugins of Cyclone DDS.
set -eu

bench=$1
work=$2
plugins=$(dirname "$(find /usr/lib -name libdds_security_auth.so 2>/dev/null | head -n 1)" 2>/dev/null)

skip() {
    echo "SKIPPED: $1"
    exit 77
}
command -v openssl >/dev/null || skip "no openssl here"
[ -f "$plugins/libdds_security_auth.so" ] || skip "Cyclone DDS has no security plugins here"

host=
finish() { [ -z "$host" ] || kill -9 "$host" 2>/dev/null || true; }
trap finish EXIT INT TERM
rm -rf "$work"
mkdir -p "$work"
cd "$work"
export ROS_DOMAIN_ID=$((210 + $$ % 10))

# ---- an authority, two machines, and what they may do

make_key() { openssl ecparam -name prime256v1 -genkey -noout -out "$1.key" 2>/dev/null; }

make_key ca
openssl req -x509 -new -key ca.key -days 30 -subj "/CN=test authority" -out ca.pem 2>/dev/null
for name in host reader; do
    make_key "$name"
    openssl req -new -key "$name.key" -subj "/CN=$name" -out "$name.csr" 2>/dev/null
    openssl x509 -req -in "$name.csr" -CA ca.pem -CAkey ca.key -CAcreateserial -days 30 -out "$name.pem" 2>/dev/null
    cat >"$name.xml" <<PERMISSIONS
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="https://www.omg.org/spec/DDS-Security/20170901/omg_shared_ca_permissions.xsd"><permissions><grant name="$name">
<subject_name>CN=$name</subject_name>
<validity><not_before>2020-01-01T00:00:00</not_before><not_after>2090-01-01T00:00:00</not_after></validity>
<allow_rule><domains><id_range><min>0</min><max>230</max></id_range></domains>
<publish><topics><topic>*</topic></topics></publish><subscribe><topics><topic>*</topic></topics></subscribe></allow_rule>
<default>DENY</default></grant></permissions></dds>
PERMISSIONS
done
cat >governance.xml <<'GOVERNANCE'
<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="https://www.omg.org/spec/DDS-Security/20170901/omg_shared_ca_governance.xsd"><domain_access_rules><domain_rule>
<domains><id_range><min>0</min><max>230</max></id_range></domains>
<allow_unauthenticated_participants>false</allow_unauthenticated_participants>
<enable_join_access_control>true</enable_join_access_control>
<discovery_protection_kind>ENCRYPT</discovery_protection_kind>
<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
<rtps_protection_kind>NONE</rtps_protection_kind>
<topic_access_rules><topic_rule><topic_expression>*</topic_expression>
<enable_discovery_protection>true</enable_discovery_protection>
<enable_liveliness_protection>true</enable_liveliness_protection>
<enable_read_access_control>true</enable_read_access_control>
<enable_write_access_control>true</enable_write_access_control>
<metadata_protection_kind>NONE</metadata_protection_kind>
<data_protection_kind>ENCRYPT</data_protection_kind></topic_rule></topic_access_rules>
</domain_rule></domain_access_rules></dds>
GOVERNANCE
for name in governance host reader; do
    openssl smime -sign -in "$name.xml" -text -out "$name.p7s" -signer ca.pem -inkey ca.key 2>/dev/null
done

# ---- Cyclone DDS's settings: lo, as the profile local, and the certificates

settings() { # NAME
    cat <<SETTINGS
<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface name="lo"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<Peers><Peer address="127.0.0.1"/></Peers></Discovery>
<Security>
<Authentication><Library path="$plugins/libdds_security_auth.so" initFunction="init_authentication" finalizeFunction="finalize_authentication"/>
<IdentityCA>file:$work/ca.pem</IdentityCA><IdentityCertificate>file:$work/$1.pem</IdentityCertificate>
<PrivateKey>file:$work/$1.key</PrivateKey></Authentication>
<AccessControl><Library path="$plugins/libdds_security_ac.so" initFunction="init_access_control" finalizeFunction="finalize_access_control"/>
<PermissionsCA>file:$work/ca.pem</PermissionsCA><Governance>file:$work/governance.p7s</Governance>
<Permissions>file:$work/$1.p7s</Permissions></AccessControl>
<Cryptographic><Library path="$plugins/libdds_security_crypto.so" initFunction="init_crypto" finalizeFunction="finalize_crypto"/></Cryptographic>
</Security></Domain></CycloneDDS>
SETTINGS
}
settings host >"$work/host.settings"
settings reader >"$work/reader.settings"

"$bench" --host --profile "$work/host.settings" --color 320x240 &
host=$!
"$bench" --read --profile "$work/reader.settings" --color 320x240 --seconds 2
if "$bench" --read --profile local --color 320x240 --seconds 1 >"$work/stranger" 2>&1; then
    cat "$work/stranger"
    echo "ros2_security: a stranger reads the camera" >&2
    exit 1
fi
echo "a stranger: $(cat "$work/stranger")"
