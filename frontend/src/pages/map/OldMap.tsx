/** An earlier version of a site's map, to look at. */
import { Modal, Skeleton } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useDevices } from "@/api/queries";
import { useOldMap } from "@/api/siteMaps";
import type { MapVersion, Site } from "@/api/types";
import { useReturnFocus } from "@/design/useReturnFocus";
import { StaticMap } from "@/map/StaticMap";
import { LoadProblem } from "@/shell/LoadProblem";
import styles from "./MapPage.module.css";

interface OldMapProps {
  site: Site;
  version: MapVersion;
  onClose: () => void;
}

export function OldMap({ site, version, onClose }: OldMapProps) {
  const { t } = useTranslation();
  const title = t("mapEdit.lookTitle", { version: version.version });
  useReturnFocus();
  const { data, error, refetch } = useOldMap(site.slug, version);
  const devices = (useDevices(site.slug).data ?? []).filter(({ kind }) => kind === "machine");
  return (
    <Modal opened onClose={onClose} title={title} size={1040}>
      <div className={styles.old}>
        {data ? (
          <StaticMap plan={data} devices={devices} label={title} />
        ) : error ? (
          <LoadProblem error={error} again={() => void refetch()} />
        ) : (
          <Skeleton height="100%" radius="md" />
        )}
      </div>
    </Modal>
  );
}
