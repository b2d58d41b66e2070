/** The versions of a site's map, and back to one of them. */
import { Button, Modal } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { Link } from "react-router-dom";
import { useDevices } from "@/api/queries";
import { useChangeMap, useMapVersions } from "@/api/robotMaps";
import type { MapVersion, Site } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import { useReturnFocus } from "@/design/useReturnFocus";
import { formatMoment } from "@/i18n/format";
import styles from "../devices/robotMap/robotmap.module.css";
import maps from "./MapPage.module.css";
import { MappingRobots } from "./MappingRobots";
import { OldMap } from "./OldMap";

function useSourceWords(slug: string) {
  const { t } = useTranslation();
  const devices = useDevices(slug).data ?? [];
  return ({ source }: MapVersion) => {
    const [kind = "", rest = ""] = source.split(/:(.*)/s);
    const name = devices.find((device) => device.id === rest)?.name ?? rest;
    return t([`robotMap.source.${kind || "other"}`, "robotMap.source.other"], { name });
  };
}

interface VersionProps {
  version: MapVersion;
  words: string;
  look: (() => void) | null;
  choose: (() => void) | null;
}

function Version({ version, words, look, choose }: VersionProps) {
  const { t } = useTranslation();
  const by = version.by ? `${version.by}, ` : "";
  return (
    <li>
      <span>{t("robotMap.version", { version: version.version, words })}</span>
      <span className={maps.versionActions}>
        {look ? (
          <Button
            size="xs"
            variant="subtle"
            aria-label={t("mapEdit.lookAt", { version: version.version })}
            onClick={look}
          >
            {t("mapEdit.look")}
          </Button>
        ) : null}
        {choose ? (
          <Button
            size="xs"
            variant="default"
            aria-label={t("robotMap.backTo", { version: version.version })}
            onClick={choose}
          >
            {t("robotMap.back")}
          </Button>
        ) : null}
      </span>
      <small>
        {by}
        {formatMoment(version.at)}
      </small>
    </li>
  );
}

export function AskBack({ site, version, current, onClose }: AskProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const change = useChangeMap(site.slug, useTellUnseen());
  const restore = () =>
    change.mutate(
      {
        do: "restore",
        version: version.version,
        tag: version.tag,
        replaces: current.version,
        replaces_tag: current.tag,
      },
      {
        onSuccess: (made) => {
          notifications.show({ message: t("robotMap.restored", { old: version.version, version: made.version }) });
          onClose();
        },
      },
    );
  return (
    <Modal opened onClose={onClose} title={t("robotMap.backAsk", { version: version.version })} size={440}>
      <p>{t("robotMap.backText")}</p>
      {change.error ? (
        <p role="alert" className={styles.problem}>
          {problemText(change.error, t("shell.problem.screen"))}
        </p>
      ) : null}
      <div className={styles.decide}>
        <Button variant="default" onClick={onClose} data-autofocus>
          {t("keys.cancel")}
        </Button>
        <Button loading={change.isPending} onClick={restore}>
          {t("robotMap.back")}
        </Button>
      </div>
    </Modal>
  );
}

interface AskProps {
  site: Site;
  version: MapVersion;
  current: MapVersion;
  onClose: () => void;
}

export function MapVersions({ site }: { site: Site }) {
  const { t } = useTranslation();
  const versions = useMapVersions(site.slug, true).data ?? [];
  const words = useSourceWords(site.slug);
  const [asked, setAsked] = useState<MapVersion | null>(null);
  const [seen, setSeen] = useState<MapVersion | null>(null);
  const current = versions[0];
  if (!current) return null;
  return (
    <section aria-labelledby="map-versions" className={styles.versions}>
      <h2 id="map-versions">{t("robotMap.versions")}</h2>
      <ul>
        {versions.map((version) => (
          <Version
            key={version.version}
            version={version}
            words={words(version)}
            look={version === current ? null : () => setSeen(version)}
            choose={site.role === "admin" && version !== current ? () => setAsked(version) : null}
          />
        ))}
      </ul>
      {site.role === "admin" ? (
        <Button component={Link} to={`/sites/${site.slug}/map/new`} variant="default" size="xs">
          {t("mapEdit.upload")}
        </Button>
      ) : null}
      <MappingRobots slug={site.slug} small />
      {seen ? <OldMap site={site} version={seen} onClose={() => setSeen(null)} /> : null}
      {asked ? <AskBack site={site} version={asked} current={current} onClose={() => setAsked(null)} /> : null}
    </section>
  );
}
