import { useTranslation } from "react-i18next";
import type { Device, MethodParameter } from "@/api/types";
import { Chip } from "@/design/Chip";
import { Panel } from "@/design/Panel";
import { unitSign } from "@/i18n/units";
import pages from "../pages.module.css";
import styles from "./detail.module.css";

function Parameter({ parameter }: { parameter: MethodParameter }) {
  const { t } = useTranslation();
  const { minimum, maximum, unit, options } = parameter;
  const range = minimum !== null && maximum !== null ? t("pages.devices.range", { minimum, maximum }) : "";
  const facts = [unitSign(unit) || (options?.length ? "" : parameter.type), range, options?.join(", ")]
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

/** What a device can be told to do, with which values, under which topic. */
export function Methods({ device }: { device: Device }) {
  const { t } = useTranslation();
  return (
    <section aria-labelledby="methods">
      <div className={styles.sectionHead}>
        <h3 id="methods">{t("pages.devices.methods")}</h3>
      </div>
      <Panel className={pages.scroll}>
        <table className={pages.table}>
          <thead>
            <tr>
              {["method", "parameter", "topic"].map((column) => (
                <th key={column} scope="col">
                  {t(`pages.devices.column.${column}`)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {device.methods.map((method) => (
              <tr key={method.name}>
                <td>
                  <code className={styles.method}>{method.name}</code>
                </td>
                <td>
                  {method.parameters.map((parameter) => (
                    <Parameter key={parameter.name} parameter={parameter} />
                  ))}
                </td>
                <td>
                  <code className={styles.topic}>{method.topic}</code>
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </Panel>
    </section>
  );
}
