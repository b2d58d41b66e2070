import { Fragment } from "react";
import { useTranslation } from "react-i18next";
import { mayOperate } from "@/api/roles";
import type { Device, DeviceMethod, MethodParameter, Site } from "@/api/types";
import { Chip } from "@/design/Chip";
import { TryButton } from "@/device/methods/TryButton";
import { Panel } from "@/design/Panel";
import { unitSign } from "@/i18n/units";
import pages from "../../pages.module.css";
import styles from "../detail.module.css";
import { LegacyTopic } from "./LegacyTopic";

function Parameter({ parameter }: { parameter: MethodParameter }) {
  const { t } = useTranslation();
  const { minimum, maximum, unit, options } = parameter;
  const range = minimum !== null && maximum !== null ? t("pages.devices.range", { minimum, maximum }) : "";
  const facts = [
    unitSign(unit) || (options?.length ? "" : t(`device.facts.type.${parameter.type}`)),
    range,
    options?.join(", "),
  ]
    .filter(Boolean)
    .join(", ");
  return (
    <span className={styles.parameter}>
      <Chip tone="machine" mono>
        {parameter.name}
      </Chip>
      {facts}
    </span>
  );
}

interface RowProps {
  site: Site;
  device: Device;
  method: DeviceMethod;
}

function Row({ site, device, method, asking }: RowProps & { asking: boolean }) {
  return (
    <tr>
      <td>
        <code className={styles.method}>{method.name}</code>
      </td>
      <td>
        {method.parameters.map((parameter) => (
          <Parameter key={parameter.name} parameter={parameter} />
        ))}
      </td>
      <td>
        <Topic topic={method.topic} />
        <LegacyTopic site={site} device={device} topic={method.topic} asking={asking} />
      </td>
      {device.lifecycle === "approved" ? (
        <td>{asking ? null : <TryButton site={site} device={device} method={method} />}</td>
      ) : null}
    </tr>
  );
}

/** What a device can be told to do, with which values, under which topic. */
export function Methods({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  return (
    <section aria-labelledby="methods">
      <div className={styles.sectionHead}>
        <h3 id="methods">{t("pages.devices.methods")}</h3>
      </div>
      {device.methods.length + device.asks.length === 0 ? (
        <p className={styles.none}>{t("device.noMethods")}</p>
      ) : (
        <MethodTable site={site} device={device} />
      )}
      {!mayOperate(site.role) ? <p className={styles.none}>{t("device.try.onlyOperators")}</p> : null}
    </section>
  );
}

function MethodTable({ site, device }: { site: Site; device: Device }) {
  const { t } = useTranslation();
  return (
    <Panel className={pages.scroll}>
      <table className={`${pages.table} ${styles.methodTable}`}>
        <thead>
          <tr>
            {["method", "parameter", "topic"].map((column) => (
              <th key={column} scope="col">
                {t(`pages.devices.column.${column}`)}
              </th>
            ))}
            {device.lifecycle === "approved" ? <th scope="col">{t("device.try.open")}</th> : null}
          </tr>
        </thead>
        <tbody>
          {device.methods.map((method) => (
            <Row key={method.name} site={site} device={device} method={method} asking={false} />
          ))}
          {device.asks.map((method) => (
            <Row key={method.name} site={site} device={device} method={method} asking />
          ))}
        </tbody>
      </table>
    </Panel>
  );
}

/** A topic that goes on in the next line behind a stroke only. */
export function Topic({ topic }: { topic: string }) {
  return (
    <code className={styles.topic}>
      {topic.split(/(?<=\/)/).map((level, index) => (
        <Fragment key={index}>
          {level}
          <wbr />
        </Fragment>
      ))}
    </code>
  );
}
