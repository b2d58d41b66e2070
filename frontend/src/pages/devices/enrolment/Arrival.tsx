import { Button, Loader } from "@mantine/core";
import { useTranslation } from "react-i18next";
import { useNavigate } from "react-router-dom";
import { useDevices } from "@/api/queries";
import type { Site } from "@/api/types";
import { StatusGlyph } from "@/design/StatusGlyph";
import { DeviceAlerts } from "@/shell/alerts/DeviceAlerts";
import styles from "./enrolment.module.css";

/** Whether the device has come; once it has, the way to it, and until then what of it was refused. */
export function Arrival({ site, id, close }: { site: Site; id: string; close: () => void }) {
  const { t } = useTranslation();
  const navigate = useNavigate();
  const come = useDevices(site.slug).data?.find((device) => device.id === id);
  const look = () => {
    close();
    void navigate(`/sites/${site.slug}/devices/${encodeURIComponent(id)}`);
  };
  return (
    <>
      <div className={styles.arrival} role="status">
        {come ? <StatusGlyph status="pending" size={16} /> : <Loader size={16} aria-hidden="true" />}
        <span>{t(come ? "adding.come" : "adding.waiting", { id, name: come?.name })}</span>
        {come ? <Button onClick={look}>{t("adding.look")}</Button> : null}
      </div>
      {come ? null : <DeviceAlerts slug={site.slug} devices={[id]} />}
    </>
  );
}
