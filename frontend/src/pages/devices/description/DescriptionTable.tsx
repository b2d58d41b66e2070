/** What a device says of itself, as a table. */
import type { ReactNode } from "react";
import { useTranslation } from "react-i18next";
import type { Device } from "@/api/types";
import { Panel } from "@/design/Panel";
import { formatNumber, withUnit } from "@/i18n/format";
import { unitSign } from "@/i18n/units";
import pages from "../../pages.module.css";
import styles from "../detail.module.css";

const metres = (value: number) => withUnit(formatNumber(value, 2), "m");

function useFacts(device: Device): [string, ReactNode][] {
  const { t } = useTranslation();
  const { x, y, theta } = device.location;
  const { size } = device;
  const facts: [string, ReactNode][] = [
    ["id", <code key="id">{device.id}</code>],
    ["kind", t(`pages.devices.kind.${device.kind}`)],
    ["class", device.device_class],
    ["location", `${metres(x)}, ${metres(y)}; ${withUnit(formatNumber((theta * 180) / Math.PI), "°")}`],
    ["size", `${metres(size.x)} × ${metres(size.y)} × ${metres(size.z)}`],
    ["radius", device.radius_m ? metres(device.radius_m) : ""],
    ["gives", device.gives.join(", ")],
    ["takes", device.takes.join(", ")],
    ["capacity", device.capacity ? formatNumber(device.capacity) : ""],
    ["simulated", device.simulated ? t("device.facts.yes") : ""],
    ["image", device.image],
  ];
  return facts.filter(([, value]) => value !== "");
}

/** The limits, or the choices, of a value. */
function limits({ minimum, maximum, options }: Device["methods"][number]["parameters"][number]): string {
  if (options?.length) return options.join(", ");
  return [minimum ?? "", maximum ?? ""].some((each) => each !== "") ? `${minimum ?? ""} … ${maximum ?? ""}` : "";
}

export function DescriptionTable({ device }: { device: Device }) {
  const { t } = useTranslation();
  const facts = useFacts(device);
  return (
    <Panel className={`${pages.scroll} ${styles.facts}`}>
      <table className={pages.table}>
        <caption>{t("device.facts.title")}</caption>
        <tbody>
          {facts.map(([name, value]) => (
            <tr key={name}>
              <th scope="row">{t(`device.facts.${name}`)}</th>
              <td colSpan={3}>{value}</td>
            </tr>
          ))}
          {device.properties.map((property) => (
            <tr key={`property ${property.name}`}>
              <th scope="row">
                {t("device.facts.property")} <code>{property.name}</code>
              </th>
              <td>{t(`device.facts.type.${property.type}`)}</td>
              <td>{unitSign(property.unit)}</td>
              <td>{limits({ ...property, options: [], required: false })}</td>
            </tr>
          ))}
          {device.methods.flatMap((method) => [
            <tr key={`method ${method.name}`}>
              <th scope="row">
                {t("device.facts.method")} <code>{method.name}</code>
              </th>
              <td colSpan={3}>{method.title}</td>
            </tr>,
            ...method.parameters.map((parameter) => (
              <tr key={`${method.name} ${parameter.name}`} className={styles.inner}>
                <th scope="row">
                  <code>{parameter.name}</code>
                  {parameter.required ? "" : ` ${t("device.facts.optional")}`}
                </th>
                <td>{t(`device.facts.type.${parameter.type}`)}</td>
                <td>{unitSign(parameter.unit)}</td>
                <td>{limits(parameter)}</td>
              </tr>
            )),
          ])}
        </tbody>
      </table>
    </Panel>
  );
}
